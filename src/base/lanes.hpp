#pragma once
// As many points as fill a vector register, taken at once.

#include "base/arrays.hpp"

#include <Eigen/Core>
#include <algorithm>

namespace asterflow {

template <class Real>
inline constexpr long n_lane = 64 / sizeof(Real);
template <class Real>
using Lanes = Eigen::Array<Real, n_lane<Real>, 1>;
template <class Real>
struct LanesOfVectors {
  Lanes<Real> x = Lanes<Real>::Zero(), y = Lanes<Real>::Zero(), z = Lanes<Real>::Zero();
};

template <class Real>
Lanes<Real> dot(Vec3<Real> a, LanesOfVectors<Real> const& r) {
  return a.x * r.x + a.y * r.y + a.z * r.z;
}

// points[first ... first + count - 1] from `origin`, the last one repeated.
template <class Real>
LanesOfVectors<Real> gather(ConstPoints points, long first, long count, Vec3d origin = {}) {
  LanesOfVectors<Real> x;
  for (int i = 0; i < n_lane<Real>; ++i) {
    Vec3d const point = points[first + std::min<long>(i, count - 1)] - origin;
    x.x[i] = Real(point.x), x.y[i] = Real(point.y), x.z[i] = Real(point.z);
  }
  return x;
}

// points[first ... first + count - 1] += scale v
template <class Real>
void add_lanes(double scale, LanesOfVectors<Real> const& v, long first, long count, Points points) {
  for (int i = 0; i < count; ++i) points[first + i] += scale * Vec3d{double(v.x[i]), double(v.y[i]), double(v.z[i])};
}

}  // namespace asterflow

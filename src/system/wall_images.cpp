#include "system/wall_images.hpp"

#include "base/parallel.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace asterflow {
namespace {

constexpr double negligible = 1e-3;  // nearness
constexpr int n_lane = 32;           // targets that are summed at once

template <class Real>
using Lanes = Eigen::Array<Real, n_lane, 1>;
template <class Real>
struct LanesOfVectors {
  Lanes<Real> x = Lanes<Real>::Zero(), y = Lanes<Real>::Zero(), z = Lanes<Real>::Zero();
};

template <class Real>
Lanes<Real> dot(Vec3d a, LanesOfVectors<Real> const& r) {
  return Real(a.x) * r.x + Real(a.y) * r.y + Real(a.z) * r.z;
}

// Targets first ... first + count - 1, the last one repeated.
LanesOfVectors<double> gather(ConstPoints targets, long first, long count) {
  LanesOfVectors<double> x;
  for (int i = 0; i < n_lane; ++i) {
    Vec3d const target = targets[first + std::min<long>(i, count - 1)];
    x.x[i] = target.x, x.y[i] = target.y, x.z[i] = target.z;
  }
  return x;
}

// u += 8 pi x flow at x of the image of the force f at the distance d (um) from the wall.
template <class Real>
void add_image(Vec3d f, Vec3d foot, Vec3d e, double d, LanesOfVectors<double> const& x, LanesOfVectors<Real>& u) {
  double const f_e = dot(f, e);
  Vec3d const a = f - (2.0 * f_e) * e, image = foot - d * e;
  LanesOfVectors<Real> const r{(x.x - image.x).template cast<Real>(), (x.y - image.y).template cast<Real>(),
                               (x.z - image.z).template cast<Real>()};
  Lanes<Real> const s = (r.x.square() + r.y.square() + r.z.square()).rsqrt(), s2 = s.square(), s3 = s * s2;
  Lanes<Real> const r_f = dot(f, r), r_a = dot(a, r), r_e = dot(e, r);
  auto const twice = Real(2.0 * d);
  Lanes<Real> const along_a = (Real(d) - r_e) * (twice * s3), along_e = r_a * (twice * s3);
  Lanes<Real> const along_r = s3 * (Real(2.0 * d * f_e) - r_f) - (Real(3) * s2) * (along_a * r_a);
  u.x += along_r * r.x + Real(a.x) * along_a + Real(e.x) * along_e - Real(f.x) * s;
  u.y += along_r * r.y + Real(a.y) * along_a + Real(e.y) * along_e - Real(f.y) * s;
  u.z += along_r * r.z + Real(a.z) * along_a + Real(e.z) * along_e - Real(f.z) * s;
}

template <class Real>
void scatter(LanesOfVectors<Real> const& u, long first, long count, Points velocity) {
  constexpr double scale = 1.0 / (8.0 * std::numbers::pi);
  for (int i = 0; i < count; ++i) velocity[first + i] += scale * Vec3d{double(u.x[i]), double(u.y[i]), double(u.z[i])};
}

}  // namespace

void WallImages::place(Surface const& wall, ConstPoints positions, ConstVector weights,
                       std::vector<std::size_t> const& first) {
  // Forces farther than 0.75 spacings are resolved to better than what curvature costs those at 0.2 spacings.
  double const reach = 0.75 * std::numbers::pi * wall.shape().size() / wall.order();
  std::vector<Image> all(positions.size());
  parallel_for("WallImages::place", static_cast<long>(first.size()) - 1, [&](long fiber) {
    for (std::size_t i = first[fiber]; i < first[fiber + 1]; ++i) {
      ClosestPoint const at = wall.shape().closest_point(positions[i]);
      double const distance = std::abs(at.distance);
      all[i] = {i, first[fiber], first[fiber + 1], at.position, -at.normal, std::exp(-std::pow(distance / reach, 8)),
                distance, std::max(distance, 0.5 * weights[i])};
    }
  });
  images_.clear();
  std::copy_if(all.begin(), all.end(), std::back_inserter(images_),
               [](Image const& image) { return image.nearness > negligible; });
}

template <class Real>
void WallImages::add_velocity(ConstPoints strengths, ConstPoints targets, Points velocity) const {
  if (images_.empty()) return;
  auto const n = static_cast<long>(targets.size());
  parallel_for("WallImages::add_velocity", (n + n_lane - 1) / n_lane, [&](long block) {
    long const first = block * n_lane, count = std::min<long>(n_lane, n - first);
    auto const x = gather(targets, first, count);
    LanesOfVectors<Real> u;
    for (Image const& image : images_)
      add_image(image.nearness * strengths[image.source], image.foot, image.normal, image.distance, x, u);
    scatter(u, first, count, velocity);
  });
}

template void WallImages::add_velocity<double>(ConstPoints, ConstPoints, Points) const;
template void WallImages::add_velocity<float>(ConstPoints, ConstPoints, Points) const;

void WallImages::add_own_resolution(ConstPoints strengths, ConstPoints positions, Points velocity) const {
  for (Image const& image : images_) {
    if (image.resolved == image.distance) continue;
    Vec3d const f = image.nearness * strengths[image.source];
    for (std::size_t first = image.first; first < image.end; first += n_lane) {
      long const count = std::min<long>(n_lane, static_cast<long>(image.end - first));
      auto const x = gather(positions, static_cast<long>(first), count);
      LanesOfVectors<double> u;
      add_image(f, image.foot, image.normal, image.resolved, x, u);
      add_image(-f, image.foot, image.normal, image.distance, x, u);
      scatter(u, static_cast<long>(first), count, velocity);
    }
  }
}

}  // namespace asterflow

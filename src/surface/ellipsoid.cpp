#include "surface/ellipsoid.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cmath>

namespace asterflow {
namespace {

int choose_polar_axis(Vec3d a) {
  if (a.y == a.z) return 0;
  if (a.z == a.x) return 1;
  if (a.x == a.y) return 2;
  return a.x >= a.y && a.x >= a.z ? 0 : (a.y >= a.z ? 1 : 2);
}

// The closest point is y_i = a_i^2 x_i / (a_i^2 + t), where t is the largest root of
//   g(t) = sum_i (a_i x_i / (a_i^2 + t))^2 - 1,  convex and falling for t > -min a_i^2.
// Newton from the left of the root rises to it monotonically. Returns -min a_i^2 if g < 0 there: then x lies on the
// medial set, where the components along the shortest axis are free.
double lagrange_multiplier(Vec3d a, Vec3d x) {
  double const lowest = -std::pow(std::min({a.x, a.y, a.z}), 2);
  double t = lowest;
  for (int i = 0; i < 3; ++i) t = std::max(t, -a[i] * a[i] + a[i] * std::abs(x[i]));
  if (t == lowest) return lowest;
  for (int iteration = 0; iteration < 200; ++iteration) {
    double g = -1.0, slope = 0.0;
    for (int i = 0; i < 3; ++i) {
      double const q = a[i] * x[i] / (a[i] * a[i] + t);
      g += q * q;
      slope -= 2.0 * q * q / (a[i] * a[i] + t);
    }
    if (g <= 0.0 && iteration > 0) break;
    double const next = t - g / slope;
    if (!(next > t) && iteration > 0) break;
    t = next;
  }
  return t;
}

}  // namespace

Ellipsoid::Ellipsoid(Vec3d semi_axes) : Shape(choose_polar_axis(semi_axes)), axes_(semi_axes) {
  ASTERFLOW_REQUIRE(semi_axes.x > 0 && semi_axes.y > 0 && semi_axes.z > 0);
}

bool Ellipsoid::axisymmetric() const { return axes_[(polar_axis() + 1) % 3] == axes_[(polar_axis() + 2) % 3]; }

SphereImage Ellipsoid::image(Vec3d d) const {
  return {{axes_.x * d.x, axes_.y * d.y, axes_.z * d.z}, Eigen::Vector3d(axes_.x, axes_.y, axes_.z).asDiagonal()};
}

void Ellipsoid::sample(Columns const& d, Columns& positions, Columns& areas) const {
  double const product = axes_.x * axes_.y * axes_.z;
  positions.resize(d.rows(), 3);
  areas.resize(d.rows(), 3);
  for (int i = 0; i < 3; ++i) {
    positions.col(i) = axes_[i] * d.col(i);
    areas.col(i) = product / axes_[i] * d.col(i);
  }
}

ClosestPoint Ellipsoid::closest_point(Vec3d x) const {
  Vec3d const a = axes_;
  double const t = lagrange_multiplier(a, x);
  Vec3d direction, offset;  // direction: y_i / a_i; offset: x - y = t x_i / (a_i^2 + t)
  double rest = 1.0;
  int free_axis = -1;
  for (int i = 0; i < 3; ++i) {
    double const denominator = a[i] * a[i] + t;
    if (denominator <= 1e-14 * a[i] * a[i]) {
      if (free_axis < 0) free_axis = i;
      continue;
    }
    direction[i] = a[i] * x[i] / denominator;
    offset[i] = t * x[i] / denominator;
    rest -= direction[i] * direction[i];
  }
  if (free_axis >= 0) {
    direction[free_axis] = std::copysign(std::sqrt(std::max(rest, 0.0)), x[free_axis]);
    offset[free_axis] = x[free_axis] - a[free_axis] * direction[free_axis];
  }
  Vec3d const y{a.x * direction.x, a.y * direction.y, a.z * direction.z};
  Vec3d const gradient{direction.x / a.x, direction.y / a.y, direction.z / a.z};
  return {y, normalized(gradient), std::copysign(norm(offset), t), direction};
}

ShellPoint Ellipsoid::shell_point(Vec3d x) const {
  Vec3d const d{x.x / axes_.x, x.y / axes_.y, x.z / axes_.z};
  return {norm(d), d};
}

double Ellipsoid::size() const { return std::max({axes_.x, axes_.y, axes_.z}); }
double Ellipsoid::aspect_ratio() const { return size() / std::min({axes_.x, axes_.y, axes_.z}); }

}  // namespace asterflow

#include "surface/ellipsoid.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace asterflow {
namespace {

int choose_polar_axis(Vec3d a) {
  if (a.y == a.z) return 0;
  if (a.z == a.x) return 1;
  if (a.x == a.y) return 2;
  return a.x >= a.y && a.x >= a.z ? 0 : (a.y >= a.z ? 1 : 2);
}

Vec3d cyclic(Vec3d v, int first) { return {v[first], v[(first + 1) % 3], v[(first + 2) % 3]}; }

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

Ellipsoid::Ellipsoid(Vec3d semi_axes) : Shape(choose_polar_axis(semi_axes)), axes_(cyclic(semi_axes, polar_axis())) {
  ASTERFLOW_REQUIRE(semi_axes.x > 0 && semi_axes.y > 0 && semi_axes.z > 0);
}

SurfacePatch Ellipsoid::patch(double theta, double phi) const {
  double const s = std::sin(theta), c = std::cos(theta), cp = std::cos(phi), sp = std::sin(phi);
  Vec3d const position{axes_.x * c, axes_.y * s * cp, axes_.z * s * sp};
  Vec3d const area{axes_.y * axes_.z * s * c, axes_.x * axes_.z * s * s * cp, axes_.x * axes_.y * s * s * sp};
  return {from_polar(position), from_polar(area)};
}

ClosestPoint Ellipsoid::closest_point(Vec3d target) const {
  Vec3d const x = to_polar(target), a = axes_;
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
  ClosestPoint result;
  result.position = from_polar(y);
  result.normal = from_polar(normalized(gradient));
  result.distance = std::copysign(norm(offset), t);
  result.theta = std::atan2(std::hypot(direction.y, direction.z), direction.x);
  result.phi = std::atan2(direction.z, direction.y);
  return result;
}

ShellPoint Ellipsoid::shell_point(Vec3d target) const {
  Vec3d const x = to_polar(target);
  Vec3d const d{x.x / axes_.x, x.y / axes_.y, x.z / axes_.z};
  double const rho = norm(d);
  return {rho, std::atan2(std::hypot(d.y, d.z), d.x), std::atan2(d.z, d.y), 1.0 - rho};
}

double Ellipsoid::size() const { return std::max({axes_.x, axes_.y, axes_.z}); }
double Ellipsoid::aspect_ratio() const { return size() / std::min({axes_.x, axes_.y, axes_.z}); }
std::string Ellipsoid::key() const {
  return fmt::format("ellipsoid {} {:a} {:a} {:a}", polar_axis(), axes_.x, axes_.y, axes_.z);
}

}  // namespace asterflow

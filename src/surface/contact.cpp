#include "surface/contact.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace asterflow {
namespace {

Vec3d rotate(Eigen::Quaterniond const& q, Vec3d v) {
  Eigen::Vector3d const result = q * Eigen::Vector3d(v.x, v.y, v.z);
  return {result[0], result[1], result[2]};
}

// Distance of a point from a surface, positive in the fluid, and the closest point; laboratory.
struct Projection {
  double distance;
  Vec3d point;
};

Projection project(PlacedSurface const& surface, Vec3d x) {
  ClosestPoint const closest = surface.shape->closest_point(surface.to_shape(x));
  return {surface.encloses ? -closest.distance : closest.distance, surface.to_laboratory(closest.position)};
}

// The least distance near a point of a surface, negative where the surfaces overlap by less than samples lie apart: quadratic
// fits over the tangent plane.
void descend(PlacedSurface const& surface, PlacedSurface const& other, Vec3d& point, Projection& best) {
  double const size = surface.shape->size();
  for (double h = 0.03 * size; h > 1e-5 * size;) {
    Vec3d const normal = surface.turn_to_laboratory(surface.shape->closest_point(surface.to_shape(point)).normal);
    Eigen::Vector3d const n(normal.x, normal.y, normal.z), u = n.unitOrthogonal(), v = n.cross(u);
    auto const at = [&](double along_u, double along_v) {
      Eigen::Vector3d const d = along_u * u + along_v * v;
      return project(surface, point + Vec3d{d[0], d[1], d[2]}).point;
    };
    auto const f = [&](double along_u, double along_v) { return project(other, at(along_u, along_v)).distance; };
    double const centre = best.distance, right = f(h, 0), left = f(-h, 0), up = f(0, h), down = f(0, -h);
    Eigen::Vector2d const slope((right - left) / (2 * h), (up - down) / (2 * h));
    double const mixed = (f(h, h) - right - up + centre) / (h * h);
    Eigen::Matrix2d curvature;
    curvature << (right - 2 * centre + left) / (h * h), mixed, mixed, (up - 2 * centre + down) / (h * h);
    bool const is_bowl = curvature.trace() > 0 && curvature.determinant() > 0;
    Eigen::Vector2d step = is_bowl ? Eigen::Vector2d(-curvature.inverse() * slope) : Eigen::Vector2d(-slope / slope.stableNorm() * h);
    if (!step.allFinite()) return;  // as close everywhere
    bool const is_far = step.norm() > h;
    if (step.norm() > 2 * h) step *= 2 * h / step.norm();
    Vec3d const next = at(step[0], step[1]);
    Projection const projection = project(other, next);
    bool const is_closer = projection.distance < best.distance;
    if (is_closer) best = projection, point = next;
    if (!(is_closer && is_far)) h *= 0.3;
  }
}

}  // namespace

Vec3d PlacedSurface::to_shape(Vec3d x) const { return turn_to_shape(x - position); }
Vec3d PlacedSurface::to_laboratory(Vec3d x) const { return position + turn_to_laboratory(x); }
Vec3d PlacedSurface::turn_to_shape(Vec3d v) const { return rotate(orientation.conjugate(), v); }
Vec3d PlacedSurface::turn_to_laboratory(Vec3d v) const { return rotate(orientation, v); }

Contact find_contact(PlacedSurface const& a, PlacedSurface const& b) {
  PlacedSurface const& sampled = a.encloses ? b : a;  // the enclosed one lies closer in every direction
  PlacedSurface const& other = a.encloses ? a : b;
  constexpr double pi = std::numbers::pi;
  Projection best{std::numeric_limits<double>::max(), {}};
  Vec3d start;
  for (int i = 0; i <= 16; ++i)
    for (int k = 0; k < 32; ++k) {
      Vec3d const x = sampled.to_laboratory(sampled.shape->point(pi * i / 16, 2.0 * pi * k / 32));
      Projection const projection = project(other, x);
      if (projection.distance < best.distance) best = projection, start = x;
    }
  for (int iteration = 0; iteration < 300 && best.distance > 0.0; ++iteration) {
    Vec3d const x = project(sampled, best.point).point;
    Projection const next = project(other, x);
    if (next.distance >= best.distance) break;
    best = next;
    start = x;
  }
  constexpr double close = 0.03;  // of the size
  if (std::abs(best.distance) < close * sampled.shape->size()) descend(sampled, other, start, best);
  Contact contact{best.distance, start, best.point};
  if (a.encloses) std::swap(contact.first, contact.second);
  return contact;
}

}  // namespace asterflow

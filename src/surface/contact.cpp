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
  Contact contact{best.distance, start, best.point};
  if (a.encloses) std::swap(contact.first, contact.second);
  return contact;
}

}  // namespace asterflow

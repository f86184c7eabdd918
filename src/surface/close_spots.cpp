#include "surface/close_spots.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace asterflow {
namespace {

CloseSpot close_spot(PlacedSurface const& surface, Vec3d point, double gap, double radius) {
  ClosestPoint const at = surface.shape->closest_point(surface.to_shape(point));
  Eigen::Vector3d const d(at.direction.x, at.direction.y, at.direction.z);
  double const stretch = (surface.shape->image(at.direction).jacobian * d.unitOrthogonal()).norm();
  return {std::sqrt(2.0 * gap * radius) / stretch, at.direction};
}

}  // namespace

CloseSpots find_close_spots(std::vector<PlacedSurface> const& surfaces) {
  CloseSpots spots(surfaces.size());
  for (std::size_t i = 0; i < surfaces.size(); ++i)
    for (std::size_t j = i + 1; j < surfaces.size(); ++j) {
      Contact const contact = find_contact(surfaces[i], surfaces[j]);
      double const radius = std::min(surfaces[i].shape->size(), surfaces[j].shape->size());
      if (!(contact.gap > 0.0)) throw SceneError(fmt::format("surfaces {} and {} overlap by {} um", i, j, -contact.gap));
      if (contact.gap < 1e-4 * radius)
        throw NumericalError(fmt::format("the gap of {} um between surfaces {} and {} is below 1e-4 of their size, {} um",
                                         contact.gap, i, j, radius));
      spots[i].push_back(close_spot(surfaces[i], contact.first, contact.gap, radius));
      spots[j].push_back(close_spot(surfaces[j], contact.second, contact.gap, radius));
    }
  for (auto& of_surface : spots) {
    std::erase_if(of_surface, [](CloseSpot const& spot) { return spot.width >= 1.0; });
    std::ranges::sort(of_surface, {}, &CloseSpot::width);
  }
  return spots;
}

Surface place_nodes(PlacedSurface const& surface, std::vector<CloseSpot> const& spots, int order) {
  if (spots.empty()) return Surface(surface.shape, order);
  // Where the contact is at a pole of an axisymmetric shape, stay on its axis exactly.
  int const axis = surface.shape->polar_axis();
  Vec3d pole = normalized(spots.front().direction);
  if (surface.shape->axisymmetric() && std::abs(pole[axis]) > 1.0 - 1e-9) {
    double const sign = pole[axis] > 0.0 ? 1.0 : -1.0;
    pole = {};
    pole[axis] = sign;
  }
  return Surface(surface.shape, order, Grading(pole_frame(pole), spots.front().width));
}

// Measured on spheres and ellipsoids: a crowded pole converges like exp(-3.2 p / K), K ~ log(8 / width); a second close
// spot, away from the pole, like the multipole series.
int order_for(std::vector<PlacedSurface> const& surfaces, CloseSpots const& spots, double accuracy) {
  double const digits = std::log(1.0 / accuracy);
  double order = 6.0;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    order = std::max(order, (4.0 + digits) * (0.6 + 0.4 * std::sqrt(surfaces[i].shape->aspect_ratio())));
    if (spots[i].empty()) continue;
    double const period = std::log(8.0 / spots[i][0].width);
    order = std::max(order, 2.0 + digits * period / 3.2);
    if (spots[i].size() > 1) order = std::max(order, 0.5 * digits * period / spots[i][1].width);
  }
  return static_cast<int>(std::ceil(order));
}

}  // namespace asterflow

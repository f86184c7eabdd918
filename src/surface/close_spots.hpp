#pragma once
// Where surfaces come close to each other, and grids whose nodes crowd there. The flow in a gap g between surfaces of
// radii a and b varies over (2 g r)^(1/2), r the smaller radius  [Kim & Karrila 1991, ch. 9].

#include "surface/contact.hpp"
#include "surface/surface.hpp"

namespace asterflow {

struct CloseSpot {
  double width;     // radians, of the gap's flow on the parameter sphere
  Vec3d direction;  // on the parameter sphere
};

// [surface] spots that need crowded nodes, the narrowest first.
using CloseSpots = std::vector<std::vector<CloseSpot>>;

// Throws SceneError where surfaces overlap, NumericalError where a gap is below 1e-4 of the smaller surface's size.
CloseSpots find_close_spots(std::vector<PlacedSurface> const& surfaces);

Surface place_nodes(PlacedSurface const& surface, std::vector<CloseSpot> const& spots, int order);

// Order of all surfaces that meets the relative accuracy.
int order_for(std::vector<PlacedSurface> const& surfaces, CloseSpots const& spots, double accuracy);

}  // namespace asterflow

#pragma once
// A shape at one of its points, to second order.

#include "surface/shapes.hpp"

namespace asterflow {

struct LocalGeometry {
  Vec3d tangent[2];     // principal directions, unit vectors
  double curvature[2];  // 1/um along them, positive where the shape bends towards its inside, as an ellipsoid does everywhere
  double stretch;       // um, root of the area per unit solid angle of directions
};

// direction: of the point, unit vector. Curvatures by differences of the normal, right to 1e-7.
LocalGeometry local_geometry(Shape const& shape, Vec3d direction);

}  // namespace asterflow

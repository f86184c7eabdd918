#pragma once
// Gaps between placed surfaces, and the gradings that resolve the flow in them.

#include "surface/grading.hpp"
#include "surface/shapes.hpp"

#include <Eigen/Geometry>

namespace asterflow {

// x in the laboratory = position + orientation * (x in the shape's frame).
struct PlacedSurface {
  std::shared_ptr<Shape const> shape;
  Vec3d position{};                                                  // um
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();   // unit
  bool encloses = false;                                             // the fluid is inside

  Vec3d to_shape(Vec3d x) const;          // position in the shape's frame
  Vec3d to_laboratory(Vec3d x) const;
  Vec3d turn_to_shape(Vec3d v) const;     // vector
  Vec3d turn_to_laboratory(Vec3d v) const;
};

struct Contact {
  double gap = 0.0;          // um, smallest distance of the surfaces, negative where they overlap
  Vec3d first, second;       // closest points, laboratory
};

// Sampling followed by alternating projection, and by quadratic fits where surfaces are close or overlap: exact there to 1e-9 of
// their size, elsewhere to about 1e-6, from above.
Contact find_contact(PlacedSurface const& a, PlacedSurface const& b);

}  // namespace asterflow

#pragma once
// The shape of a closed surface as a scene describes it, about its own centre and axes:
//   sphere      radius
//   ellipsoid   semi_axes along x, y, z
//   revolution  a profile turned about the x axis
// Keys shape, radius, semi_axes, profile of [[body]] and [periphery].

#include "base/table.hpp"

#include <array>
#include <vector>

namespace asterflow {

struct ShapeSpec {
  enum class Kind { sphere, ellipsoid, revolution };

  Kind kind = Kind::sphere;
  double radius = 1.0;                             // um, > 0, of a sphere
  Vec3d semi_axes{1.0, 1.0, 1.0};                  // um, > 0, of an ellipsoid
  std::vector<std::array<double, 2>> profile = {};  // um, points [x, distance from the x axis] of a surface of
                                                   // revolution, from one pole (distance 0) to the other, x increasing

  bool operator==(ShapeSpec const&) const = default;
};

// Reads the shape keys of a table that may have others. The key `shape` must be there, and the one that goes with it.
ShapeSpec read_shape(Table& table);

// Distance from the centre to the farthest point, um.
double outer_radius(ShapeSpec const& shape);

}  // namespace asterflow

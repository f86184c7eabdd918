#pragma once
// Where the motors of the cortex sit: points of a closed surface, spread uniformly by area.

#include "base/arrays.hpp"
#include "surface/shapes.hpp"

namespace asterflow {

// Independent points. The same seed gives the same points, and more of them the same first ones.
PointArray random_sites(Shape const& shape, int count, std::uint64_t seed);

// Points on a spiral about an axis: equal areas of the surface between the heights of successive points (the area of a
// ring is spread over its turns as on a surface of revolution), each the golden angle further than the last.
PointArray even_sites(Shape const& shape, Vec3d axis, int count);

}  // namespace asterflow

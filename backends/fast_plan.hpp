#pragma once
// Choice of the octree by predicted cost: the side of its root decides, within a factor of two, the size of all
// boxes, hence how the work divides between pairs and grids; the capacity of leaves its depth; the first level
// what the one grid in free space covers.

#include "backends/fast_parameters.hpp"
#include "backends/fast_tree.hpp"

#include <memory>

namespace asterflow {

struct Plan {
  OctreeOptions octree;
  double cost = 0.0;  // predicted, of one sum, in nanoseconds of one core
};

// components: of the strengths on the grid.
Plan best_plan(ConstPoints sources, ConstPoints targets, FastParameters const& parameters, int components);

}  // namespace asterflow

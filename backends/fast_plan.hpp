#pragma once
// Choice of the octree by predicted cost: the side of its root decides, within a factor of two, the size of all
// boxes, hence how the work divides between pairs and grids; the capacity of leaves its depth; the first level
// what the one grid in free space covers.

#include "backends/fast_parameters.hpp"
#include "backends/fast_boxes.hpp"

#include <memory>

namespace asterflow {

struct Plan {
  OctreeOptions octree;
  double cost = 0.0;  // predicted, of one sum, in nanoseconds of one core
};

// Whether sources or targets are so few that direct sums are taken: a point alone costs more on grids.
bool is_direct(std::size_t n_source, std::size_t n_target, FastParameters const& parameters);

// Throws SceneError when a coordinate is not finite. Nothing is predicted for direct sums.
Plan best_plan(std::string_view kernel, ConstPoints sources, ConstPoints targets, FastParameters const& parameters);

}  // namespace asterflow

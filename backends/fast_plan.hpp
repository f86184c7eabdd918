#pragma once
// Choice of the octree: the side of its root decides, within a factor of two, the size of all boxes, hence how
// the work divides between pairs and grids. A few sides are tried and the cheapest by a cost model is kept.

#include "backends/fast_parameters.hpp"
#include "backends/fast_tree.hpp"

#include <memory>

namespace asterflow {

// Predicted work of one sum, in nanoseconds of one core. The tree may hold one of every `thinning` points.
double predicted_cost(Octree const& tree, FastParameters const& parameters, int components, double thinning = 1.0);

std::unique_ptr<Octree> best_octree(ConstPoints sources, ConstPoints targets, FastParameters const& parameters,
                                    int components);

}  // namespace asterflow

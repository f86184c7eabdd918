#pragma once
// How many strengths may add up at one node of a grid: decides in which numbers they are added.

#include "backends/fast_grid.hpp"

namespace asterflow {

// For every tile of the patch: no node's sum of the weights of all its sources is larger.
template <class Real>
std::vector<float> crowding(GridWindow<Real> const& window, Patch<Real> const& patch, PointArray const& points,
                            std::vector<Range> const& ranges);

}  // namespace asterflow

#pragma once
// Direct sums scale all points into the range of their arithmetic. Where a target lies 1e20 sizes of the sources away no scale
// suits all distances; this evaluator then sums the given coordinates in double, by the reference.

#include "backends/evaluator.hpp"

namespace asterflow {

// `scaled` for all points that one scale suits.
std::unique_ptr<Evaluator> for_any_reach(std::string_view kernel, std::unique_ptr<Evaluator> scaled);

}  // namespace asterflow

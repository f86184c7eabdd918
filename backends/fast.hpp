#pragma once
// Fast summation with given parameters, for tests and tuning; make_fast() chooses them from the accuracy.

#include "backends/evaluator.hpp"
#include "backends/fast_parameters.hpp"

namespace asterflow {

std::unique_ptr<Evaluator> make_fast(std::string_view kernel, FastParameters const& parameters);

}  // namespace asterflow

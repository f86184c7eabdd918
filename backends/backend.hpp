#pragma once
// The makers of the evaluators of each backend. A new backend adds its maker here and one line to the
// table in evaluator.cpp.

#include "backends/evaluator.hpp"

namespace asterflow {

std::unique_ptr<Evaluator> make_reference(std::string_view kernel, double accuracy);

}  // namespace asterflow

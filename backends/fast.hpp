#pragma once
// Fast summation with given parameters and loops, for tuning; the makers in backend.hpp choose them.

#include "backends/evaluator.hpp"
#include "backends/fast_parameters.hpp"

namespace asterflow {

// Vector loops of the host, or Kokkos's default execution space.
enum class FastInstructions { portable, avx2, avx512, device };

// The error is what the parameters make it: nobody checks.
std::unique_ptr<Evaluator> make_fast(std::string_view kernel, FastParameters const& parameters,
                                     FastInstructions instructions, std::string_view name);

}  // namespace asterflow

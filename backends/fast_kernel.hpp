#pragma once
// The kernels of the fast summation by name, and what it needs to know of them besides their formulas.

#include "backends/fast_loops.hpp"
#include "base/error.hpp"

#include <string_view>

namespace asterflow {

inline FastKernel fast_kernel(std::string_view name) {
  if (name == "stokeslet") return FastKernel::stokeslet;
  if (name == "stresslet") return FastKernel::stresslet;
  if (name == "rotlet") return FastKernel::rotlet;
  if (name == "stokeslet_pressure") return FastKernel::stokeslet_pressure;
  ASTERFLOW_REQUIRE(name == "stresslet_pressure");
  return FastKernel::stresslet_pressure;
}

inline bool has_normal(FastKernel kernel) {
  return kernel == FastKernel::stresslet || kernel == FastKernel::stresslet_pressure;
}

// Components of the strengths on the grid: 3; with normals 6, those of the symmetric q n: xx yy zz xy xz yz.
inline int n_component(FastKernel kernel) { return has_normal(kernel) ? 6 : 3; }

// A sum falls off as 1 / distance^decay.
inline int decay(FastKernel kernel) {
  return kernel == FastKernel::stokeslet ? 1 : kernel == FastKernel::stresslet_pressure ? 3 : 2;
}

}  // namespace asterflow

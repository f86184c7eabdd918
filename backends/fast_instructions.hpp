#pragma once
// The inner loops of the fast summation by instruction set.

#include "backends/fast.hpp"
#include "backends/fast_loops.hpp"

namespace asterflow {

template <class Real>
FastLoops<Real> fast_loops_of([[maybe_unused]] FastInstructions instructions) {
#ifdef ASTERFLOW_HAS_X86_SIMD
  if (instructions == FastInstructions::avx512) return fast_loops_avx512<Real>();
  if (instructions == FastInstructions::avx2) return fast_loops_avx2<Real>();
#endif
  return fast_loops_portable<Real>();
}

}  // namespace asterflow

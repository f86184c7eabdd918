// Inner loops of the fast summation for AVX-512 (F, DQ, VL).

#include "backends/fast_loops.inl"

namespace asterflow {

template <class Real>
FastLoops<Real> fast_loops_avx512() {
  return fast_loops<Real>();
}

template FastLoops<float> fast_loops_avx512<float>();
template FastLoops<double> fast_loops_avx512<double>();

}  // namespace asterflow

// Inner loops of the fast summation for AVX2 and FMA.

#include "backends/fast_loops.inl"

namespace asterflow {

template <class Real>
FastLoops<Real> fast_loops_avx2() {
  return fast_loops<Real>();
}

template FastLoops<float> fast_loops_avx2<float>();
template FastLoops<double> fast_loops_avx2<double>();

}  // namespace asterflow

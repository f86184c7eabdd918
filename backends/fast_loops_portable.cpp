// Inner loops of the fast summation for any processor, with vector registers of 16 bytes.

#include "backends/fast_loops.inl"

namespace asterflow {

template <class Real>
FastLoops<Real> fast_loops_portable() {
  return fast_loops<Real>();
}

template FastLoops<float> fast_loops_portable<float>();
template FastLoops<double> fast_loops_portable<double>();

}  // namespace asterflow

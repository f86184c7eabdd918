// Pair loops for AVX-512 (F, DQ, VL). Compiled with the flags of that instruction set; run only where cpuid allows.

#include <immintrin.h>

namespace asterflow {
namespace {

// Vector registers of AVX-512: eight doubles or sixteen floats. Operators are those of the compiler's
// vector types.
// groups_at_once registers of targets are worked on together: as many as the register file holds.
template <class Real>
struct Pack;

template <>
struct Pack<double> {
  using Vector = double __attribute__((vector_size(64)));
  static constexpr int lanes = 8;
  static constexpr int groups_at_once = 2;
  static Vector splat(double a) { return _mm512_set1_pd(a); }
  // a where it is positive; 0 where it is negative or not a number.
  static Vector positive_part(Vector a) { return _mm512_maskz_max_pd(0xff, a, _mm512_setzero_pd()); }
  // 1 / sqrt(a) to within estimate_error; not a number for a < 0.
  static Vector inverse_sqrt_estimate(Vector a) { return _mm512_maskz_rsqrt14_pd(0xff, a); }
  static constexpr double estimate_error = 0x1p-14;
};

template <>
struct Pack<float> {
  using Vector = float __attribute__((vector_size(64)));
  static constexpr int lanes = 16;
  static constexpr int groups_at_once = 2;
  static Vector splat(float a) { return _mm512_set1_ps(a); }
  static Vector positive_part(Vector a) { return _mm512_maskz_max_ps(0xffff, a, _mm512_setzero_ps()); }
  static Vector inverse_sqrt_estimate(Vector a) { return _mm512_maskz_rsqrt14_ps(0xffff, a); }
  static constexpr double estimate_error = 0x1p-14;
};

}  // namespace
}  // namespace asterflow

#include "backends/pair_loop.inl"

namespace asterflow {

template <class Real>
PairSums<Real> avx512_pair_sums(int i_kernel, int steps) {
  return pair_sums_of<Real>(i_kernel, steps, static_cast<AllSums const*>(nullptr));
}

template PairSums<float> avx512_pair_sums<float>(int, int);
template PairSums<double> avx512_pair_sums<double>(int, int);

}  // namespace asterflow

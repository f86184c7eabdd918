// Pair loops for AVX2 and FMA. Compiled with the flags of that instruction set; run only where cpuid allows.

#include <immintrin.h>

namespace asterflow {
namespace {

// Vector registers of AVX2: four doubles or eight floats. Operators are those of the compiler's vector
// types.
// groups_at_once registers of targets are worked on together: as many as the register file holds.
template <class Real>
struct Pack;

template <>
struct Pack<double> {
  using Vector = double __attribute__((vector_size(32)));
  static constexpr int lanes = 4;
  static constexpr int groups_at_once = 1;
  static Vector splat(double a) { return _mm256_set1_pd(a); }
  // a where it is positive; 0 where it is negative or not a number.
  static Vector positive_part(Vector a) { return _mm256_max_pd(a, _mm256_setzero_pd()); }
  // 1 / sqrt(a) to within estimate_error; not a number for a < 0. There is only an estimate in float,
  // so 1e-37 < |a| < 1e38 is assumed.
  static Vector inverse_sqrt_estimate(Vector a) { return _mm256_cvtps_pd(_mm_rsqrt_ps(_mm256_cvtpd_ps(a))); }
  static constexpr double estimate_error = 1.5 * 0x1p-12;
};

template <>
struct Pack<float> {
  using Vector = float __attribute__((vector_size(32)));
  static constexpr int lanes = 8;
  static constexpr int groups_at_once = 1;
  static Vector splat(float a) { return _mm256_set1_ps(a); }
  static Vector positive_part(Vector a) { return _mm256_max_ps(a, _mm256_setzero_ps()); }
  static Vector inverse_sqrt_estimate(Vector a) { return _mm256_rsqrt_ps(a); }
  static constexpr double estimate_error = 1.5 * 0x1p-12;
};

}  // namespace
}  // namespace asterflow

#include "backends/pair_loop.inl"

namespace asterflow {

template <class Real>
PairSums<Real> avx2_pair_sums(int i_kernel, int steps) {
  return pair_sums_of<Real>(i_kernel, steps, static_cast<AllSums const*>(nullptr));
}

template PairSums<float> avx2_pair_sums<float>(int, int);
template PairSums<double> avx2_pair_sums<double>(int, int);

}  // namespace asterflow

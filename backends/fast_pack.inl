// Short vectors of float or double for the inner loops of the fast summation: as wide as the instruction set
// the including file is compiled for. Arithmetic operators are the compiler's vector extension.

#include <cmath>
#include <cstdint>
#include <cstring>

#if defined(__AVX512F__) || defined(__AVX2__)
#include <immintrin.h>
#endif

namespace asterflow {
namespace {

#if defined(__AVX512F__)
constexpr int pack_bytes = 64;
#elif defined(__AVX2__)
constexpr int pack_bytes = 32;
#else
constexpr int pack_bytes = 16;
#endif

template <class Real>
struct PackOf;
template <>
struct PackOf<float> {
  typedef float type __attribute__((vector_size(pack_bytes)));
};
template <>
struct PackOf<double> {
  typedef double type __attribute__((vector_size(pack_bytes)));
};

template <class Real>
using Pack = typename PackOf<Real>::type;

template <class Real>
constexpr int lanes = pack_bytes / static_cast<int>(sizeof(Real));

template <class Real>
inline Pack<Real> load(Real const* p) {
  Pack<Real> v;
  std::memcpy(&v, p, pack_bytes);
  return v;
}

// A vector of floats from as many doubles, and what needs no conversion.
template <class Real>
inline Pack<Real> load_as(Real const* p) {
  return load(p);
}
template <class Real>
inline Pack<float> load_as(double const* p)
  requires(sizeof(Real) == 4)
{
#if defined(__AVX512F__)
  __m512 const low = _mm512_castps256_ps512(_mm512_cvtpd_ps(_mm512_loadu_pd(p)));
  return (Pack<float>)_mm512_insertf32x8(low, _mm512_cvtpd_ps(_mm512_loadu_pd(p + 8)), 1);
#elif defined(__AVX2__)
  return (Pack<float>)_mm256_set_m128(_mm256_cvtpd_ps(_mm256_loadu_pd(p + 4)), _mm256_cvtpd_ps(_mm256_loadu_pd(p)));
#else
  Pack<float> v{};
  for (int i = 0; i < lanes<float>; ++i) v[i] = static_cast<float>(p[i]);
  return v;
#endif
}

template <class Real>
inline Pack<Real> load_as(std::int32_t const* p)
  requires(sizeof(Real) == 4)
{
  typedef std::int32_t Whole __attribute__((vector_size(pack_bytes)));
  Whole v;
  std::memcpy(&v, p, pack_bytes);
  return __builtin_convertvector(v, Pack<float>);
}

// Whole numbers next to those of a vector of floats.
typedef std::int32_t Whole4 __attribute__((vector_size(16)));
typedef float Float4 __attribute__((vector_size(16)));
inline Whole4 nearest(Float4 x) {
#if defined(__AVX2__)
  return (Whole4)_mm_cvtps_epi32((__m128)x);
#else
  Float4 const half = {0.5f, 0.5f, 0.5f, 0.5f};
  return __builtin_convertvector(x < Float4{} ? x - half : x + half, Whole4);
#endif
}
#if defined(__AVX2__)
typedef std::int32_t Whole8 __attribute__((vector_size(32)));
typedef float Float8 __attribute__((vector_size(32)));
inline Whole8 nearest(Float8 x) { return (Whole8)_mm256_cvtps_epi32((__m256)x); }
#endif
#if defined(__AVX512F__)
typedef std::int32_t Whole16 __attribute__((vector_size(64)));
typedef float Float16 __attribute__((vector_size(64)));
inline Whole16 nearest(Float16 x) { return (Whole16)_mm512_cvtps_epi32((__m512)x); }
#endif

template <class Real>
inline void store(Real* p, Pack<Real> v) {
  std::memcpy(p, &v, pack_bytes);
}

template <class Real>
inline Pack<Real> broadcast(Real s) {
  return Pack<Real>{} + s;
}

inline int smaller(int a, int b) { return a < b ? a : b; }
inline long smaller(long a, long b) { return a < b ? a : b; }

// Lanes where a < b, and a vector that is zero elsewhere.
#if defined(__AVX512F__)
inline __mmask16 less(Pack<float> a, Pack<float> b) { return _mm512_cmp_ps_mask((__m512)a, (__m512)b, _CMP_LT_OQ); }
inline __mmask8 less(Pack<double> a, Pack<double> b) { return _mm512_cmp_pd_mask((__m512d)a, (__m512d)b, _CMP_LT_OQ); }
inline Pack<float> only(__mmask16 lanes, Pack<float> a) { return (Pack<float>)_mm512_maskz_mov_ps(lanes, (__m512)a); }
inline Pack<double> only(__mmask8 lanes, Pack<double> a) { return (Pack<double>)_mm512_maskz_mov_pd(lanes, (__m512d)a); }
#else
template <class Vector>
inline auto less(Vector a, Vector b) {
  return a < b;
}
template <class Lanes, class Vector>
inline Vector only(Lanes lanes, Vector a) {
  return lanes ? a : Vector{};
}
#endif

// The hardware's estimate of 1 / sqrt(x), to 14 digits of two (AVX-512) or 12 (AVX2, only float); exact elsewhere: in double an
// estimate from float would not cover small distances. 0 for 0.
template <class Real>
constexpr bool estimates_root = pack_bytes == 64 || (pack_bytes == 32 && sizeof(Real) == 4);
template <class Real>
inline Pack<Real> reciprocal_square_root(Pack<Real> x) {
#if defined(__AVX512F__)
  auto const positive = less(Pack<Real>{}, x);
  if constexpr (sizeof(Real) == 8)
    return (Pack<Real>)_mm512_maskz_rsqrt14_pd(positive, (__m512d)x);
  else
    return (Pack<Real>)_mm512_maskz_rsqrt14_ps(positive, (__m512)x);
#else
  Pack<Real> y{};
#if defined(__AVX2__)
  if constexpr (sizeof(Real) == 8)
    y = Real(1) / (Pack<Real>)_mm256_sqrt_pd((__m256d)x);
  else
    y = (Pack<Real>)_mm256_rsqrt_ps((__m256)x);
#else
  for (int i = 0; i < lanes<Real>; ++i) y[i] = Real(1) / std::sqrt(x[i]);
#endif
  return only(less(Pack<Real>{}, x), y);
#endif
}

// sum[0 ... 2] += sign times the sum of the lanes of each vector; sum[3] is left alone or added zero to.
template <int sign, class Real>
inline void add_lane_sums(Pack<Real> const (&v)[3], Real* sum) {
#if defined(__AVX2__)
  if constexpr (sizeof(Real) == 4) {
    __m128 part[3];
    for (int d = 0; d < 3; ++d) {
#if defined(__AVX512F__)
      __m256 const half = _mm256_add_ps(_mm512_castps512_ps256((__m512)v[d]), _mm512_extractf32x8_ps((__m512)v[d], 1));
#else
      __m256 const half = (__m256)v[d];
#endif
      part[d] = _mm_add_ps(_mm256_castps256_ps128(half), _mm256_extractf128_ps(half, 1));
    }
    __m128 const all = _mm_hadd_ps(_mm_hadd_ps(part[0], part[1]), _mm_hadd_ps(part[2], _mm_setzero_ps()));
    __m128 const before = _mm_loadu_ps(sum);
    _mm_storeu_ps(sum, sign > 0 ? _mm_add_ps(before, all) : _mm_sub_ps(before, all));
  } else {
    __m256d part[3];
    for (int d = 0; d < 3; ++d) {
#if defined(__AVX512F__)
      part[d] = _mm256_add_pd(_mm512_castpd512_pd256((__m512d)v[d]), _mm512_maskz_extractf64x4_pd(0xf, (__m512d)v[d], 1));
#else
      part[d] = (__m256d)v[d];
#endif
    }
    __m256d const xy = _mm256_hadd_pd(part[0], part[1]), z = _mm256_hadd_pd(part[2], _mm256_setzero_pd());
    __m256d const all = _mm256_add_pd(_mm256_permute2f128_pd(xy, z, 0x20), _mm256_permute2f128_pd(xy, z, 0x31));
    __m256d const before = _mm256_loadu_pd(sum);
    _mm256_storeu_pd(sum, sign > 0 ? _mm256_add_pd(before, all) : _mm256_sub_pd(before, all));
  }
#else
  for (int d = 0; d < 3; ++d)
    for (int i = 0; i < lanes<Real>; ++i) sum[d] += sign * v[d][i];
#endif
}

// Transposes a square of lanes x lanes numbers: row i of the result is column i of the input.
template <class Real>
inline void transpose(Pack<Real>* rows) {
  constexpr int n = lanes<Real>;
  alignas(64) Real in[n][n], out[n][n];
  std::memcpy(in, rows, sizeof in);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) out[i][j] = in[j][i];
  std::memcpy(rows, out, sizeof out);
}
// In double by pairs of rows and then by squares of 2 x 2 numbers, which compilers do number by number.
#if defined(__AVX512F__)
template <>
inline void transpose<double>(Pack<double>* rows) {
  __m512d pairs[8];
  for (int i = 0; i < 8; i += 2) {
    pairs[i] = _mm512_unpacklo_pd((__m512d)rows[i], (__m512d)rows[i + 1]);
    pairs[i + 1] = _mm512_unpackhi_pd((__m512d)rows[i], (__m512d)rows[i + 1]);
  }
  for (int i = 0; i < 2; ++i) {
    constexpr int even = 0x88, odd = 0xdd;
    __m512d const a = _mm512_shuffle_f64x2(pairs[i], pairs[i + 2], even), b = _mm512_shuffle_f64x2(pairs[i], pairs[i + 2], odd);
    __m512d const c = _mm512_shuffle_f64x2(pairs[i + 4], pairs[i + 6], even), d = _mm512_shuffle_f64x2(pairs[i + 4], pairs[i + 6], odd);
    rows[i] = (Pack<double>)_mm512_shuffle_f64x2(a, c, even);
    rows[i + 2] = (Pack<double>)_mm512_shuffle_f64x2(b, d, even);
    rows[i + 4] = (Pack<double>)_mm512_shuffle_f64x2(a, c, odd);
    rows[i + 6] = (Pack<double>)_mm512_shuffle_f64x2(b, d, odd);
  }
}
#elif defined(__AVX2__)
template <>
inline void transpose<double>(Pack<double>* rows) {
  for (int i = 0; i < 4; i += 2) {
    __m256d const low = _mm256_unpacklo_pd((__m256d)rows[i], (__m256d)rows[i + 1]);
    __m256d const high = _mm256_unpackhi_pd((__m256d)rows[i], (__m256d)rows[i + 1]);
    rows[i] = (Pack<double>)low;
    rows[i + 1] = (Pack<double>)high;
  }
  for (int i = 0; i < 2; ++i) {
    __m256d const a = (__m256d)rows[i], b = (__m256d)rows[i + 2];
    rows[i] = (Pack<double>)_mm256_permute2f128_pd(a, b, 0x20);
    rows[i + 2] = (Pack<double>)_mm256_permute2f128_pd(a, b, 0x31);
  }
}
#endif

}  // namespace
}  // namespace asterflow

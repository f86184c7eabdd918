#pragma once
// Short vectors of float or double for the host phases of the fast summation: as wide as the instruction set
// this file is compiled for. Arithmetic operators are the compiler's vector extension (g++, clang++).

#include <cmath>
#include <cstring>

#if defined(__AVX512F__) || defined(__AVX__)
#include <immintrin.h>
#endif

namespace asterflow {

#if defined(__AVX512F__)
constexpr int pack_bytes = 64;
#elif defined(__AVX__)
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

template <class Real>
inline void store(Real* p, Pack<Real> v) {
  std::memcpy(p, &v, pack_bytes);
}

template <class Real>
inline Pack<Real> broadcast(Real s) {
  return Pack<Real>{} + s;
}

// 1 / sqrt(x): the hardware estimate improved by `steps` of Newton's method (14 bits, doubled by each step).
template <class Real, int steps>
inline Pack<Real> reciprocal_square_root(Pack<Real> x) {
  Pack<Real> y;
#if defined(__AVX512F__)
  if constexpr (sizeof(Real) == 8)
    y = (Pack<Real>)_mm512_rsqrt14_pd((__m512d)x);
  else
    y = (Pack<Real>)_mm512_rsqrt14_ps((__m512)x);
  Pack<Real> const half = Real(0.5) * x;
  for (int i = 0; i < steps; ++i) y = y * (Real(1.5) - half * y * y);
#else
  for (int i = 0; i < lanes<Real>; ++i) y[i] = Real(1) / std::sqrt(x[i]);
#endif
  return y;
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

}  // namespace asterflow

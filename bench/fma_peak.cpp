#include "fma_peak.hpp"

#include "base/cpu_time.hpp"
#include "base/parallel.hpp"

#include <algorithm>
#include <vector>

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>
#endif

namespace asterflow {
namespace {

constexpr long n_chain = 12;  // independent sums: more than latency times units of any processor so far
constexpr long n_round = 200000;

using Loop = void (*)();

#if defined(__x86_64__) && defined(__GNUC__)

#define ASTERFLOW_FMA_LOOP(name, instructions, Vector, set, fma)                        \
  __attribute__((target(instructions))) void name() {                                   \
    Vector const a = set(0.999), b = set(0.001);                                        \
    Vector x0 = a, x1 = a, x2 = a, x3 = a, x4 = a, x5 = a;                              \
    Vector x6 = b, x7 = b, x8 = b, x9 = b, x10 = b, x11 = b;                            \
    for (long i = 0; i < n_round; ++i) {                                                \
      x0 = fma(x0, a, b), x1 = fma(x1, a, b), x2 = fma(x2, a, b), x3 = fma(x3, a, b);   \
      x4 = fma(x4, a, b), x5 = fma(x5, a, b), x6 = fma(x6, a, b), x7 = fma(x7, a, b);   \
      x8 = fma(x8, a, b), x9 = fma(x9, a, b), x10 = fma(x10, a, b), x11 = fma(x11, a, b); \
      asm volatile("" : "+v"(x0), "+v"(x1), "+v"(x2), "+v"(x3), "+v"(x4), "+v"(x5));    \
      asm volatile("" : "+v"(x6), "+v"(x7), "+v"(x8), "+v"(x9), "+v"(x10), "+v"(x11));  \
    }                                                                                   \
  }

ASTERFLOW_FMA_LOOP(avx2_double, "avx2,fma", __m256d, _mm256_set1_pd, _mm256_fmadd_pd)
ASTERFLOW_FMA_LOOP(avx2_float, "avx2,fma", __m256, _mm256_set1_ps, _mm256_fmadd_ps)
ASTERFLOW_FMA_LOOP(avx512_double, "avx512f", __m512d, _mm512_set1_pd, _mm512_fmadd_pd)
ASTERFLOW_FMA_LOOP(avx512_float, "avx512f", __m512, _mm512_set1_ps, _mm512_fmadd_ps)

#undef ASTERFLOW_FMA_LOOP

Loop find_loop(std::string_view instructions, int bits) {
  if (instructions == "avx512" && __builtin_cpu_supports("avx512f")) return bits == 64 ? avx512_double : avx512_float;
  if (instructions == "avx2" && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    return bits == 64 ? avx2_double : avx2_float;
  return nullptr;
}

#else

Loop find_loop(std::string_view, int) { return nullptr; }

#endif

}  // namespace

double fma_per_second(std::string_view instructions, int bits) {
  Loop const loop = find_loop(instructions, bits);
  if (loop == nullptr) return 0.0;
  std::vector<double> rates(40 * static_cast<std::size_t>(thread_count()));
  parallel_for("bench::fma_per_second", static_cast<long>(rates.size()), [&](long task) {
    double const start = thread_cpu_seconds();
    loop();
    rates[task] = static_cast<double>(n_round * n_chain) / (thread_cpu_seconds() - start);
  });
  return *std::max_element(rates.begin(), rates.end());
}

}  // namespace asterflow

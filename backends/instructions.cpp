// Which vector instructions this build has loops for and this machine can run.

#include "backends/backend.hpp"

namespace asterflow {

#ifdef ASTERFLOW_HAS_X86_SIMD

bool has_avx2() { return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"); }

bool has_avx512() {
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
}

#else

bool has_avx2() { return false; }
bool has_avx512() { return false; }

#endif

}  // namespace asterflow

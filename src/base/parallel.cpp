#include "base/parallel.hpp"

#include <Kokkos_Core.hpp>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <mutex>

namespace asterflow {

namespace {

using HostThreads = Kokkos::DefaultHostExecutionSpace;

}  // namespace

ParallelScope::ParallelScope() {
  setenv("OMP_PROC_BIND", "false", 0);  // several programs on one machine must not share a core; also silences Kokkos
  Kokkos::initialize();
}
ParallelScope::~ParallelScope() { Kokkos::finalize(); }

std::string kokkos_version() {
  return std::to_string(KOKKOS_VERSION / 10000) + "." + std::to_string(KOKKOS_VERSION / 100 % 100) + "." +
         std::to_string(KOKKOS_VERSION % 100);
}

int thread_count() { return HostThreads().concurrency(); }

void parallel_ranges(char const* label, long n, RangeCall call, void const* body) {
  long const size = std::max(1L, n / (64 * thread_count()));  // short enough for uneven work, long enough for even
  std::exception_ptr failure;
  std::mutex guard;
  Kokkos::RangePolicy<HostThreads, Kokkos::Schedule<Kokkos::Dynamic>, Kokkos::IndexType<long>> policy(0, (n + size - 1) / size);
  policy.set_chunk_size(1);
  Kokkos::parallel_for(std::string("asterflow::") + label, policy, [&](long range) {
    try {
      call(body, range * size, std::min((range + 1) * size, n));
    } catch (...) {
      std::scoped_lock lock(guard);
      if (!failure) failure = std::current_exception();
    }
  });
  if (failure) std::rethrow_exception(failure);
}

}  // namespace asterflow

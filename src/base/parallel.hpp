#pragma once
// Loops over host threads. Each index is handled by one thread, so results do not depend on the
// number of threads as long as the body writes only what belongs to its index.

#include <Kokkos_Core.hpp>

#include <algorithm>
#include <exception>
#include <mutex>
#include <string>

namespace asterflow {

using HostSpace = Kokkos::DefaultHostExecutionSpace;

inline int thread_count() { return HostSpace().concurrency(); }

// body(i) for i in [0, n); work per index may be uneven. An exception thrown by a body is rethrown here.
template <class Body>
void parallel_for(char const* label, long n, Body const& body) {
  std::exception_ptr failure;
  std::mutex guard;
  using Policy = Kokkos::RangePolicy<HostSpace, Kokkos::Schedule<Kokkos::Dynamic>, Kokkos::IndexType<long>>;
  Policy policy(0, n);
  policy.set_chunk_size(static_cast<int>(std::max(1L, n / (16 * thread_count()))));  // even and uneven work alike
  Kokkos::parallel_for(std::string("asterflow::") + label, policy, [&](long i) {
    try {
      body(i);
    } catch (...) {
      std::scoped_lock lock(guard);
      if (!failure) failure = std::current_exception();
    }
  });
  if (failure) std::rethrow_exception(failure);
}

}  // namespace asterflow

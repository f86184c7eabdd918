#pragma once
// Loops over host threads. Each index is handled by one thread, so results do not depend on the
// number of threads as long as the body writes only what belongs to its index.
// The threads are Kokkos's, but no header of Kokkos is read here: code that only loops compiles sooner, and by
// the host's compiler where Kokkos wants a device's.

#include <string>

namespace asterflow {

// Starts Kokkos, its host threads and its device, and stops them at the end of the scope. One a program.
class ParallelScope {
 public:
  ParallelScope();
  ~ParallelScope();
  ParallelScope(ParallelScope const&) = delete;
  ParallelScope& operator=(ParallelScope const&) = delete;
};

std::string kokkos_version();  // "4.6.1"

int thread_count();

// call(body, begin, end) for ranges that together are [0, n); n may be 0. An exception is rethrown here.
using RangeCall = void (*)(void const* body, long begin, long end);
void parallel_ranges(char const* label, long n, RangeCall call, void const* body);

// body(i) for i in [0, n); work per index may be uneven. An exception thrown by a body is rethrown here.
template <class Body>
void parallel_for(char const* label, long n, Body const& body) {
  RangeCall const call = [](void const* data, long begin, long end) {
    auto const& each = *static_cast<Body const*>(data);
    for (long i = begin; i < end; ++i) each(i);
  };
  parallel_ranges(label, n, call, &body);
}

}  // namespace asterflow

#pragma once
// What the kernels of the fast sum for any execution space share.

#include "backends/default_space.hpp"

#include <Kokkos_Core.hpp>

#include <string>
#include <vector>

namespace asterflow {

using DeviceSpace = Kokkos::DefaultExecutionSpace;
using DeviceRange = Kokkos::RangePolicy<DeviceSpace, Kokkos::IndexType<long>>;
using DeviceTeamPolicy = Kokkos::TeamPolicy<DeviceSpace, Kokkos::IndexType<long>>;
using DeviceTeam = DeviceTeamPolicy::member_type;

template <class Number>
using DeviceArray = Kokkos::View<Number*, DeviceSpace>;
template <class Number>
using DeviceScratch = Kokkos::View<Number*, DeviceSpace::scratch_memory_space, Kokkos::MemoryUnmanaged>;

// Scratch memory of a team that every space has close to its cores; more of it is slower memory.
inline constexpr long close_scratch = 32000;  // bytes
inline int scratch_level(long bytes) { return bytes <= close_scratch ? 0 : 1; }

// Makes `array` hold at least n numbers.
template <class Number>
void grow(DeviceArray<Number>& array, std::size_t n, char const* label) {
  if (array.extent(0) < n)
    array = DeviceArray<Number>(Kokkos::view_alloc(std::string("asterflow::Fast::") + label, Kokkos::WithoutInitializing), n);
}

// n numbers to the beginning of `array`, which grows where it must.
template <class Number>
void send(DeviceArray<Number>& array, Number const* numbers, std::size_t n, char const* label) {
  grow(array, n, label);
  Kokkos::View<Number const*, Kokkos::HostSpace, Kokkos::MemoryUnmanaged> const here(numbers, n);
  Kokkos::deep_copy(Kokkos::subview(array, std::make_pair(std::size_t{0}, n)), here);
}
template <class Number>
void send(DeviceArray<Number>& array, std::vector<Number> const& numbers, char const* label) {
  send(array, numbers.data(), numbers.size(), label);
}

// Which of n pieces item k belongs to: begin [n + 1] holds the first item of each.
KOKKOS_INLINE_FUNCTION int piece_of(long const* begin, int n, long k) {
  int low = 0, high = n;
  while (high - low > 1) {
    int const middle = (low + high) / 2;
    (begin[middle] <= k ? low : high) = middle;
  }
  return low;
}

KOKKOS_INLINE_FUNCTION int wrapped_node(int i, int n) { return i < 0 ? i + n : i >= n ? i - n : i; }

}  // namespace asterflow

#pragma once
// Where Kokkos runs by default: on the host's threads, or on a device with memory of its own.

#include <Kokkos_Core.hpp>

namespace asterflow {

inline constexpr bool default_space_is_host =
    Kokkos::SpaceAccessibility<Kokkos::HostSpace, Kokkos::DefaultExecutionSpace::memory_space>::accessible;

}  // namespace asterflow

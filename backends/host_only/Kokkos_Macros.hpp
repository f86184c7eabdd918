#pragma once
// Stands in for Kokkos's header of this name in the loops for host vector registers (cmake/PairLoops.cmake), which
// are compiled without Kokkos, by the host's compiler even where everything else goes through a device's.
// Always inlined: no function compiled for one instruction set may be linked into another.

#define KOKKOS_INLINE_FUNCTION inline __attribute__((always_inline))

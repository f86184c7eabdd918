#pragma once
// Every pair kernel, the pressures of those that have one, and the step from a name to its type.

#include "kernels/rotlet.hpp"
#include "kernels/stokeslet.hpp"
#include "kernels/stokeslet_pressure.hpp"
#include "kernels/stresslet.hpp"
#include "kernels/stresslet_pressure.hpp"

#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>

namespace asterflow {

using AllKernels = std::tuple<Stokeslet, Stresslet, Rotlet>;

// What backends sum: flows and, as flows (p, 0, 0), pressures. That of a rotlet is zero.
using AllSums = std::tuple<Stokeslet, Stresslet, Rotlet, StokesletPressure, StressletPressure>;

static_assert(PairKernel<Stokeslet> && PairKernel<Stresslet> && PairKernel<Rotlet> && PairKernel<StokesletPressure> &&
              PairKernel<StressletPressure>);

// Calls visit(Kernel{}) for the kernel called `name`; returns false when there is none.
template <class Kernels = AllSums, class Visit>
bool with_kernel(std::string_view name, Visit&& visit) {
  return std::apply(
      [&](auto... kernel) {
        return ((decltype(kernel)::name == name ? (visit(kernel), true) : false) || ...);
      },
      Kernels{});
}

// "stokeslet, stresslet, rotlet", for messages.
inline std::string kernel_names() {
  std::string names;
  std::apply([&](auto... kernel) { ((names += (names.empty() ? "" : ", ") + std::string(kernel.name)), ...); },
             AllKernels{});
  return names;
}

}  // namespace asterflow

#pragma once
// Every pair kernel, and the step from a kernel's name to its type.

#include "kernels/rotlet.hpp"
#include "kernels/stokeslet.hpp"
#include "kernels/stresslet.hpp"

#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>

namespace asterflow {

using AllKernels = std::tuple<Stokeslet, Stresslet, Rotlet>;

static_assert(PairKernel<Stokeslet> && PairKernel<Stresslet> && PairKernel<Rotlet>);

// Calls visit(Kernel{}) for the kernel called `name`; returns false when there is none.
template <class Visit>
bool with_kernel(std::string_view name, Visit&& visit) {
  return std::apply(
      [&](auto... kernel) {
        return ((decltype(kernel)::name == name ? (visit(kernel), true) : false) || ...);
      },
      AllKernels{});
}

// "stokeslet, stresslet, rotlet", for messages.
inline std::string kernel_names() {
  std::string names;
  std::apply([&](auto... kernel) { ((names += (names.empty() ? "" : ", ") + std::string(kernel.name)), ...); },
             AllKernels{});
  return names;
}

}  // namespace asterflow

#pragma once
// A pair kernel: velocity at distance r = target - source from one singularity, in unbounded Stokes
// flow of viscosity 1. A kernel is a stateless struct with
//   name        the word used in scenes and on the command line
//   flops       floating-point operations of one pair, one division and one square root counted once each
//   has_normal  true when a source carries a unit normal n besides its strength q
//   prefactor   the constant in front of the formula
//   decay       velocity(c r) = velocity(r) / c^decay
//   parity      velocity(-r) = parity velocity(r), +1 or -1
//   shape(r, s, q, n)  the formula without its prefactor, given s = 1 / |r|; s = 0 must give 0
//   velocity(r, q, n)  zero at r = 0 (a source does not act on itself)
// Kernels are pointwise; who sums them is the business of backends/. `Real` may be a vector of numbers
// (SIMD), so shape() has no branches.

#include "base/vec3.hpp"

#include <concepts>
#include <string_view>

namespace asterflow {

template <class K>
concept PairKernel = requires(Vec3<double> v) {
  { K::name } -> std::convertible_to<std::string_view>;
  { K::flops } -> std::convertible_to<int>;
  { K::has_normal } -> std::convertible_to<bool>;
  { K::prefactor } -> std::convertible_to<double>;
  { K::decay } -> std::convertible_to<int>;
  { K::parity } -> std::convertible_to<int>;
  { K::template shape<double>(v, 1.0, v, v) } -> std::same_as<Vec3<double>>;
  { K::template velocity<double>(v, v, v) } -> std::same_as<Vec3<double>>;
};

// 1 / |r|, and 0 at r = 0.
template <class Real>
KOKKOS_INLINE_FUNCTION Real inverse_distance(Vec3<Real> r) {
  using std::sqrt;
  Real const r2 = dot(r, r);
  return r2 > Real(0) ? Real(1) / sqrt(r2) : Real(0);
}

}  // namespace asterflow

#pragma once
// A number and its derivatives with respect to the three coordinates of a target (forward automatic
// differentiation [Griewank & Walther 2008]). A kernel's shape() in these numbers gives velocity and gradient.

#include "base/vec3.hpp"

namespace asterflow {

template <class Real>
struct Dual {
  Real value{};
  Real slope[3]{};  // d / dx, d / dy, d / dz

  Dual() = default;
  KOKKOS_INLINE_FUNCTION Dual(Real v) : value(v) {}
  KOKKOS_INLINE_FUNCTION Dual(Real v, Real x, Real y, Real z) : value(v), slope{x, y, z} {}

  KOKKOS_INLINE_FUNCTION Dual& operator+=(Dual const& b) {
    value += b.value;
    for (int d = 0; d < 3; ++d) slope[d] += b.slope[d];
    return *this;
  }
  KOKKOS_INLINE_FUNCTION Dual& operator-=(Dual const& b) {
    value -= b.value;
    for (int d = 0; d < 3; ++d) slope[d] -= b.slope[d];
    return *this;
  }
  KOKKOS_INLINE_FUNCTION Dual& operator*=(Dual const& b) {
    for (int d = 0; d < 3; ++d) slope[d] = slope[d] * b.value + value * b.slope[d];
    value *= b.value;
    return *this;
  }
  friend KOKKOS_INLINE_FUNCTION Dual operator+(Dual a, Dual const& b) { return a += b; }
  friend KOKKOS_INLINE_FUNCTION Dual operator-(Dual a, Dual const& b) { return a -= b; }
  friend KOKKOS_INLINE_FUNCTION Dual operator*(Dual a, Dual const& b) { return a *= b; }
  friend KOKKOS_INLINE_FUNCTION Dual operator*(Dual a, float s) {
    a.value *= s;
    for (Real& slope : a.slope) slope *= s;
    return a;
  }
  friend KOKKOS_INLINE_FUNCTION Dual operator-(Dual const& a) { return Dual() - a; }
};

// The distance from a source as numbers with derivatives; s = 1 / |r|, 0 at r = 0, likewise.
template <class Real>
KOKKOS_INLINE_FUNCTION Vec3<Dual<Real>> differentiable(Vec3<Real> r) {
  Real const zero{}, one = Real{} + 1;
  return {{r.x, one, zero, zero}, {r.y, zero, one, zero}, {r.z, zero, zero, one}};
}
template <class Real>
KOKKOS_INLINE_FUNCTION Dual<Real> differentiable_inverse(Vec3<Real> r, Real s) {
  Real const cube = -s * s * s;
  return {s, cube * r.x, cube * r.y, cube * r.z};
}

}  // namespace asterflow

#pragma once
// Pressure of a point force f on the fluid, whatever the viscosity:  p = r . f / (4 pi r^3)    [Pozrikidis 1992, eq. 2.2.9]
// Summed as a flow (p, 0, 0), by whatever sums flows.

#include "kernels/kernel.hpp"

namespace asterflow {

struct StokesletPressure {
  static constexpr std::string_view name = "stokeslet_pressure";
  static constexpr int flops = 17;
  static constexpr bool has_normal = false;
  static constexpr double prefactor = 0.079577471545947673;  // 1 / (4 pi)
  static constexpr int decay = 2;
  static constexpr int parity = -1;

  template <class Real>
  KOKKOS_INLINE_FUNCTION static Vec3<Real> shape(Vec3<Real> r, Real s, Vec3<Real> f, Vec3<Real> = {}) {
    return {dot(r, f) * (s * s * s), Real{}, Real{}};
  }

  template <class Real>
  KOKKOS_INLINE_FUNCTION static Vec3<Real> velocity(Vec3<Real> r, Vec3<Real> f, Vec3<Real> = {}) {
    return Real(prefactor) * shape(r, inverse_distance(r), f);
  }
};

}  // namespace asterflow

#pragma once
// Pressure of a double layer of density q on an element with unit normal n, viscosity 1:
//   p = -(1 / (2 pi)) (3 (r . q) (r . n) / r^5 - q . n / r^3)    [Pozrikidis 1992, eq. 2.3.17]
// Summed as a flow (p, 0, 0), by whatever sums flows.

#include "kernels/kernel.hpp"

namespace asterflow {

struct StressletPressure {
  static constexpr std::string_view name = "stresslet_pressure";
  static constexpr int flops = 28;
  static constexpr bool has_normal = true;
  static constexpr double prefactor = -0.15915494309189535;  // -1 / (2 pi)
  static constexpr int decay = 3;
  static constexpr int parity = 1;

  template <class Real>
  KOKKOS_INLINE_FUNCTION static Vec3<Real> shape(Vec3<Real> r, Real s, Vec3<Real> q, Vec3<Real> n) {
    Real const s2 = s * s;
    return {(dot(r, q) * dot(r, n) * s2 * 3.0f - dot(q, n)) * (s2 * s), Real{}, Real{}};
  }

  template <class Real>
  KOKKOS_INLINE_FUNCTION static Vec3<Real> velocity(Vec3<Real> r, Vec3<Real> q, Vec3<Real> n) {
    return Real(prefactor) * shape(r, inverse_distance(r), q, n);
  }
};

}  // namespace asterflow

#pragma once
// Double layer of density q on an element with unit normal n:
//   u = -(3 / (4 pi)) r (r . q) (r . n) / r^5    [Power & Miranda 1987; Pozrikidis 1992, eq. 2.3.12]
// With n outward on a closed surface, constant q gives q inside, q / 2 on the surface, 0 outside.
// The density is a velocity: no viscosity appears.

#include "kernels/kernel.hpp"

namespace asterflow {

struct Stresslet {
  static constexpr std::string_view name = "stresslet";
  static constexpr int flops = 30;
  static constexpr bool has_normal = true;
  static constexpr double prefactor = -0.23873241463784303;  // -3 / (4 pi)
  static constexpr int decay = 2;
  static constexpr int parity = -1;

  template <class Real>
  KOKKOS_INLINE_FUNCTION static Vec3<Real> shape(Vec3<Real> r, Real s, Vec3<Real> q, Vec3<Real> n) {
    Real const s2 = s * s;
    return (dot(r, q) * dot(r, n) * (s2 * s2 * s)) * r;
  }

  template <class Real>
  KOKKOS_INLINE_FUNCTION static Vec3<Real> velocity(Vec3<Real> r, Vec3<Real> q, Vec3<Real> n) {
    return Real(prefactor) * shape(r, inverse_distance(r), q, n);
  }
};

}  // namespace asterflow

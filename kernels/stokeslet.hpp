#pragma once
// Point force f on the fluid:  u = (f / r + r (r . f) / r^3) / (8 pi)    [Pozrikidis 1992, eq. 2.2.8]

#include "kernels/kernel.hpp"

namespace asterflow {

struct Stokeslet {
  static constexpr std::string_view name = "stokeslet";
  static constexpr int flops = 29;
  static constexpr bool has_normal = false;
  static constexpr double prefactor = 0.039788735772973834;  // 1 / (8 pi)

  template <class Real>
  KOKKOS_INLINE_FUNCTION static Vec3<Real> velocity(Vec3<Real> r, Vec3<Real> f, Vec3<Real> = {}) {
    Real const s = inverse_distance(r);
    return (Real(prefactor) * s) * (f + (dot(r, f) * s * s) * r);
  }
};

}  // namespace asterflow

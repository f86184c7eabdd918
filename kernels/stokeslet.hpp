#pragma once
// Point force f on the fluid:  u = (f / r + r (r . f) / r^3) / (8 pi)    [Pozrikidis 1992, eq. 2.2.8]

#include "kernels/kernel.hpp"

namespace asterflow {

struct Stokeslet {
  static constexpr std::string_view name = "stokeslet";
  static constexpr int flops = 29;
  static constexpr bool has_normal = false;
  static constexpr double prefactor = 0.039788735772973834;  // 1 / (8 pi)
  static constexpr int decay = 1;
  static constexpr int parity = 1;

  template <class Real>
  KOKKOS_INLINE_FUNCTION static Vec3<Real> shape(Vec3<Real> r, Real s, Vec3<Real> f, Vec3<Real> = {}) {
    return s * (f + (dot(r, f) * (s * s)) * r);
  }

  template <class Real>
  KOKKOS_INLINE_FUNCTION static Vec3<Real> velocity(Vec3<Real> r, Vec3<Real> f, Vec3<Real> = {}) {
    return Real(prefactor) * shape(r, inverse_distance(r), f);
  }
};

}  // namespace asterflow

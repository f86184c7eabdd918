#pragma once
// Point torque t on the fluid:  u = t x r / (8 pi r^3)    [Kim & Karrila 1991, sec. 2.5]

#include "kernels/kernel.hpp"

namespace asterflow {

struct Rotlet {
  static constexpr std::string_view name = "rotlet";
  static constexpr int flops = 25;
  static constexpr bool has_normal = false;
  static constexpr double prefactor = 0.039788735772973834;  // 1 / (8 pi)
  static constexpr int decay = 2;
  static constexpr int parity = -1;

  template <class Real>
  KOKKOS_INLINE_FUNCTION static Vec3<Real> shape(Vec3<Real> r, Real s, Vec3<Real> t, Vec3<Real> = {}) {
    return (s * s * s) * cross(t, r);
  }

  template <class Real>
  KOKKOS_INLINE_FUNCTION static Vec3<Real> velocity(Vec3<Real> r, Vec3<Real> t, Vec3<Real> = {}) {
    return Real(prefactor) * shape(r, inverse_distance(r), t);
  }
};

}  // namespace asterflow

#pragma once
// A 3-vector of plain numbers, usable on host and device. An array of Vec3<double> is [n, 3] doubles.

#include <Kokkos_Macros.hpp>
#include <cmath>

namespace asterflow {

template <class Real>
struct Vec3 {
  Real x{}, y{}, z{};

  KOKKOS_INLINE_FUNCTION Real& operator[](int i) { return (&x)[i]; }
  KOKKOS_INLINE_FUNCTION Real operator[](int i) const { return (&x)[i]; }

  KOKKOS_INLINE_FUNCTION Vec3& operator+=(Vec3 b) { x += b.x; y += b.y; z += b.z; return *this; }
  KOKKOS_INLINE_FUNCTION Vec3& operator-=(Vec3 b) { x -= b.x; y -= b.y; z -= b.z; return *this; }
  KOKKOS_INLINE_FUNCTION Vec3& operator*=(Real s) { x *= s; y *= s; z *= s; return *this; }

  friend bool operator==(Vec3 const&, Vec3 const&) = default;
  friend KOKKOS_INLINE_FUNCTION Vec3 operator+(Vec3 a, Vec3 b) { return a += b; }
  friend KOKKOS_INLINE_FUNCTION Vec3 operator-(Vec3 a, Vec3 b) { return a -= b; }
  friend KOKKOS_INLINE_FUNCTION Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
  friend KOKKOS_INLINE_FUNCTION Vec3 operator*(Real s, Vec3 a) { return a *= s; }
  friend KOKKOS_INLINE_FUNCTION Vec3 operator*(Vec3 a, Real s) { return a *= s; }
  friend KOKKOS_INLINE_FUNCTION Vec3 operator/(Vec3 a, Real s) { return a *= Real(1) / s; }
};

template <class Real>
KOKKOS_INLINE_FUNCTION Real dot(Vec3<Real> a, Vec3<Real> b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

template <class Real>
KOKKOS_INLINE_FUNCTION Vec3<Real> cross(Vec3<Real> a, Vec3<Real> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <class Real>
KOKKOS_INLINE_FUNCTION Real norm(Vec3<Real> a) { using std::sqrt; return sqrt(dot(a, a)); }

template <class Real>
KOKKOS_INLINE_FUNCTION Vec3<Real> normalized(Vec3<Real> a) { return a / norm(a); }

using Vec3d = Vec3<double>;

}  // namespace asterflow

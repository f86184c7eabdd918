// The local part of each kernel for one pair, or a vector of pairs: see fast_split.hpp for the formulas, here
// without 1 / 8 pi. a, b: the polynomials A, B; `inverse`: 1 / r; what lies outside the cutoff is left out by
// the caller. add_of() has the local functions of r before the tensors, `first` and `second`, at hand. `Number` is a number, a vector or a Dual of them; source: strength, then normal.

#include <Kokkos_Macros.hpp>

namespace asterflow {
namespace {

struct NearStokeslet {
  static constexpr int parity = 1;  // of the sum in r
  static constexpr int powers = 1;  // A scales as 1 / cutoff, B as 1 / cutoff^3
  template <class Number, class Inside, class Real>
  KOKKOS_INLINE_FUNCTION static void add(Number const (&r)[3], Number const& inverse, Number const& a, Number const& b, Inside const& inside,
                  Real const* f, Number (&u)[3]) {
    add_of(r, inside(inverse - a), inside(inverse * inverse * inverse - b), f, u);
  }
  template <class Number, class Real>
  KOKKOS_INLINE_FUNCTION static void add_of(Number const (&r)[3], Number const& first, Number const& second, Real const* f, Number (&u)[3]) {
    Number const along = second * (r[0] * f[0] + r[1] * f[1] + r[2] * f[2]);
    for (int d = 0; d < 3; ++d) u[d] += first * f[d] + along * r[d];
  }
};

struct NearRotlet {
  static constexpr int parity = -1;
  static constexpr int powers = 1;
  template <class Number, class Inside, class Real>
  KOKKOS_INLINE_FUNCTION static void add(Number const (&r)[3], Number const& inverse, Number const&, Number const& b, Inside const& inside,
                  Real const* t, Number (&u)[3]) {
    add_of(r, Number(), inside(inverse * inverse * inverse - b), t, u);
  }
  template <class Number, class Real>
  KOKKOS_INLINE_FUNCTION static void add_of(Number const (&r)[3], Number const&, Number const& s, Real const* t, Number (&u)[3]) {
    u[0] += s * (r[2] * t[1] - r[1] * t[2]);
    u[1] += s * (r[0] * t[2] - r[2] * t[0]);
    u[2] += s * (r[1] * t[0] - r[0] * t[1]);
  }
};

struct NearStokesletPressure {
  static constexpr int parity = -1;
  static constexpr int powers = 1;
  template <class Number, class Inside, class Real>
  KOKKOS_INLINE_FUNCTION static void add(Number const (&r)[3], Number const& inverse, Number const&, Number const& b, Inside const& inside,
                  Real const* f, Number (&p)[3]) {
    add_of(r, Number(), inside((inverse * inverse * inverse - b) * 2.0f), f, p);
  }
  template <class Number, class Real>
  KOKKOS_INLINE_FUNCTION static void add_of(Number const (&r)[3], Number const&, Number const& second, Real const* f, Number (&p)[3]) {
    p[0] += second * (r[0] * f[0] + r[1] * f[1] + r[2] * f[2]);
  }
};

struct NearStresslet {
  static constexpr int parity = -1;
  static constexpr int powers = 3;  // A scales as 1 / cutoff^3, B as 1 / cutoff^5
  template <class Number, class Inside, class Real>
  KOKKOS_INLINE_FUNCTION static void add(Number const (&r)[3], Number const& inverse, Number const& a, Number const& b, Inside const& inside,
                  Real const* q, Number (&u)[3]) {
    Real const* n = q + 3;
    Number const first = inside(-a);
    Number const rq = r[0] * q[0] + r[1] * q[1] + r[2] * q[2], rn = r[0] * n[0] + r[1] * n[1] + r[2] * n[2];
    Number const cube = inverse * inverse * inverse;
    Number second;
    if constexpr (requires { inverse.slope; })  // the slope of the fifth power alone would overflow in float
      second = inside((cube * (rq * inverse) * (rn * inverse) - b * rq * rn) * -6.0f);
    else
      second = inside((cube * (inverse * inverse) - b) * -6.0f) * rq * rn;
    add_products(r, rq, rn, first, second, q, u);
  }
  template <class Number, class Real>
  KOKKOS_INLINE_FUNCTION static void add_of(Number const (&r)[3], Number const& first, Number const& second, Real const* q, Number (&u)[3]) {
    Real const* n = q + 3;
    Number const rq = r[0] * q[0] + r[1] * q[1] + r[2] * q[2], rn = r[0] * n[0] + r[1] * n[1] + r[2] * n[2];
    add_products(r, rq, rn, first, second * rq * rn, q, u);
  }
  template <class Number, class Real>
  KOKKOS_INLINE_FUNCTION static void add_products(Number const (&r)[3], Number const& rq, Number const& rn, Number const& first,
                                                  Number const& second, Real const* q, Number (&u)[3]) {
    Real const* n = q + 3;
    Number const along = second + first * (q[0] * n[0] + q[1] * n[1] + q[2] * n[2]);
    Number const by_q = first * rn, by_n = first * rq;
    for (int d = 0; d < 3; ++d) u[d] += along * r[d] + by_q * q[d] + by_n * n[d];
  }
};

struct NearStressletPressure {
  static constexpr int parity = 1;
  static constexpr int powers = 3;
  template <class Number, class Inside, class Real>
  KOKKOS_INLINE_FUNCTION static void add(Number const (&r)[3], Number const& inverse, Number const& a, Number const& b, Inside const& inside,
                  Real const* q, Number (&p)[3]) {
    Real const* n = q + 3;
    Number const rq = r[0] * q[0] + r[1] * q[1] + r[2] * q[2], rn = r[0] * n[0] + r[1] * n[1] + r[2] * n[2];
    Number const cube = inverse * inverse * inverse;
    Number const first = (cube - a) * (q[0] * n[0] + q[1] * n[1] + q[2] * n[2]);
    Number const second = cube * (rq * inverse) * (rn * inverse) - b * rq * rn;
    p[0] += inside(first * 4.0f - second * 12.0f);
  }
  template <class Number, class Real>
  KOKKOS_INLINE_FUNCTION static void add_of(Number const (&r)[3], Number const& first, Number const& second, Real const* q, Number (&p)[3]) {
    Real const* n = q + 3;
    Number const rq = r[0] * q[0] + r[1] * q[1] + r[2] * q[2], rn = r[0] * n[0] + r[1] * n[1] + r[2] * n[2];
    p[0] += first * (q[0] * n[0] + q[1] * n[1] + q[2] * n[2]) + second * rq * rn;
  }
};

}  // namespace
}  // namespace asterflow

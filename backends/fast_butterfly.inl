// The innermost step of the one-dimensional Fourier transforms, for numbers or vectors of them.

#include <Kokkos_Macros.hpp>

namespace asterflow {
namespace {

// y_j = sum over i of x_i exp(-2 pi i i j / radix) for one group of `radix` numbers, in place.
template <int radix, class P, class Real>
KOKKOS_INLINE_FUNCTION void butterfly(P* r, P* i) {
  if constexpr (radix == 2) {
    P const tr = r[0] - r[1], ti = i[0] - i[1];
    r[0] += r[1], i[0] += i[1];
    r[1] = tr, i[1] = ti;
  } else if constexpr (radix == 3) {
    constexpr Real s = Real(0.86602540378443864676);
    P const ar = r[1] + r[2], ai = i[1] + i[2], br = s * (r[1] - r[2]), bi = s * (i[1] - i[2]);
    P const mr = r[0] - Real(0.5) * ar, mi = i[0] - Real(0.5) * ai;
    r[0] += ar, i[0] += ai;
    r[1] = mr + bi, i[1] = mi - br;
    r[2] = mr - bi, i[2] = mi + br;
  } else if constexpr (radix == 4) {
    P const ar = r[0] + r[2], ai = i[0] + i[2], br = r[0] - r[2], bi = i[0] - i[2];
    P const cr = r[1] + r[3], ci = i[1] + i[3], dr = r[1] - r[3], di = i[1] - i[3];
    r[0] = ar + cr, i[0] = ai + ci;
    r[1] = br + di, i[1] = bi - dr;
    r[2] = ar - cr, i[2] = ai - ci;
    r[3] = br - di, i[3] = bi + dr;
  } else {
    constexpr Real c1 = Real(0.30901699437494742410), s1 = Real(0.95105651629515357212);
    constexpr Real c2 = Real(-0.80901699437494742410), s2 = Real(0.58778525229247312917);
    P const ar = r[1] + r[4], ai = i[1] + i[4], br = r[1] - r[4], bi = i[1] - i[4];
    P const cr = r[2] + r[3], ci = i[2] + i[3], dr = r[2] - r[3], di = i[2] - i[3];
    P const m1r = r[0] + c1 * ar + c2 * cr, m1i = i[0] + c1 * ai + c2 * ci;
    P const m2r = r[0] + c2 * ar + c1 * cr, m2i = i[0] + c2 * ai + c1 * ci;
    P const n1r = s1 * br + s2 * dr, n1i = s1 * bi + s2 * di;
    P const n2r = s2 * br - s1 * dr, n2i = s2 * bi - s1 * di;
    r[0] += ar + cr, i[0] += ai + ci;
    r[1] = m1r + n1i, i[1] = m1i - n1r;
    r[4] = m1r - n1i, i[4] = m1i + n1r;
    r[2] = m2r + n2i, i[2] = m2i - n2r;
    r[3] = m2r - n2i, i[3] = m2i + n2r;
  }
}

// Group p of one pass over n = radix m numbers for number q of s interleaved transforms; w: twiddle factors of the
// group, cos and sin by turns.
template <class Real, int radix, class P>
KOKKOS_INLINE_FUNCTION void line_group(P const* xr, P const* xi, P* yr, P* yi, int m, int s, int p, int q, Real const* w) {
  P r[radix], i[radix];
  for (int k = 0; k < radix; ++k) r[k] = xr[q + s * (p + k * m)], i[k] = xi[q + s * (p + k * m)];
  butterfly<radix, P, Real>(r, i);
  P* const zr = yr + q + s * radix * p;
  P* const zi = yi + q + s * radix * p;
  zr[0] = r[0], zi[0] = i[0];
  for (int k = 1; k < radix; ++k) {
    Real const c = w[2 * k - 2], d = w[2 * k - 1];
    zr[s * k] = r[k] * c + i[k] * d;
    zi[s * k] = i[k] * c - r[k] * d;
  }
}

}  // namespace
}  // namespace asterflow

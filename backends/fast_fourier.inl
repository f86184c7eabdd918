// One-dimensional complex Fourier transforms of many lines at once, one line per vector lane. Self-sorting
// (Stockham) mixed radix [Van Loan 1992, sec. 1.7].

namespace asterflow {
namespace {

// y_j = sum over i of x_i exp(-2 pi i i j / radix) for one group of `radix` numbers, in place.
template <int radix, class P, class Real>
inline void butterfly(P* r, P* i) {
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

// One pass of one radix over n / radix groups for each of s interleaved transforms; w: its twiddle factors.
template <class Real, int radix>
void line_stage(Pack<Real> const* xr, Pack<Real> const* xi, Pack<Real>* yr, Pack<Real>* yi, int n, int s, Real const* w) {
  using P = Pack<Real>;
  int const m = n / radix;
  for (int p = 0; p < m; ++p, w += 2 * (radix - 1)) {
    for (int q = 0; q < s; ++q) {
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
  }
}

// x_k = sum over j of x_j exp(-2 pi i j k / n), without scale. The line is (re, im); (work_re, work_im) is scratch
// of the same length. True when the result is in the scratch. The inverse is the same with re and im
// exchanged throughout.
template <class Real>
bool transform_lines(LineView<Real> const& line, Pack<Real>* re, Pack<Real>* im, Pack<Real>* work_re,
                     Pack<Real>* work_im) {
  bool swapped = false;
  int n = line.length, s = 1;
  Real const* w = line.twiddles;
  for (int i = 0; i < line.n_radix; ++i) {
    int const radix = line.radices[i];
    Pack<Real> *xr = swapped ? work_re : re, *xi = swapped ? work_im : im;
    Pack<Real> *yr = swapped ? re : work_re, *yi = swapped ? im : work_im;
    if (radix == 4)
      line_stage<Real, 4>(xr, xi, yr, yi, n, s, w);
    else if (radix == 2)
      line_stage<Real, 2>(xr, xi, yr, yi, n, s, w);
    else if (radix == 3)
      line_stage<Real, 3>(xr, xi, yr, yi, n, s, w);
    else
      line_stage<Real, 5>(xr, xi, yr, yi, n, s, w);
    w += 2 * (radix - 1) * (n / radix);
    n /= radix;
    s *= radix;
    swapped = !swapped;
  }
  return swapped;
}

}  // namespace
}  // namespace asterflow

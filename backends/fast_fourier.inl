// One-dimensional complex Fourier transforms of many lines at once, one line per vector lane. Self-sorting
// (Stockham) mixed radix [Van Loan 1992, sec. 1.7].

#include "backends/fast_butterfly.inl"

namespace asterflow {
namespace {

// One pass of one radix over n / radix groups for each of s interleaved transforms; w: its twiddle factors.
template <class Real, int radix>
void line_stage(Pack<Real> const* xr, Pack<Real> const* xi, Pack<Real>* yr, Pack<Real>* yi, int n, int s, Real const* w) {
  int const m = n / radix;
  for (int p = 0; p < m; ++p, w += 2 * (radix - 1))
    for (int q = 0; q < s; ++q) line_group<Real, radix>(xr, xi, yr, yi, m, s, p, q, w);
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

#pragma once
// Each kernel as a smooth part, band-limited in Fourier space, plus a local part that vanishes beyond a
// cutoff [Hasimoto 1959; Lindbo & Tornberg 2010; af Klinteberg, Greengard, Jiang & Tornberg 2025].
// All kernels are derivatives of the biharmonic function r:
//   Stokeslet  (I lap - grad grad) r          rotlet  curl (lap r / 2)
//   stresslet  (delta_ik d_j + delta_ij d_k + delta_jk d_i) lap r - 2 d_i d_j d_k r      (all / 8 pi)
// and their pressures  -(f . grad) lap r  and  -2 (q . grad) (n . grad) lap r.
// r is replaced by W(r) with W'' = 2 g, g a window on [-1, 1]: W equals r beyond the cutoff 1 and is smooth
// inside. In Fourier space W is -8 pi / k^4 times filter(k) = spectrum(k) - k spectrum'(k) / 2.

#include "backends/fast_window.hpp"

#include <string_view>
#include <vector>

namespace asterflow {

// The local part for cutoff 1, with A, B functions of r^2, polynomials on each of some equal pieces of 0 ... 1:
//   Stokeslet  (1/r - A) f + (1/r^3 - B) r (r.f)
//   rotlet     (1/r^3 - B) t x r
//   stresslet  -A (q (n.r) + n (q.r) + (q.n) r) - 6 (1/r^5 - B) r (q.r) (n.r)
//   pressures  2 (1/r^3 - B) (r.f)  and  4 (1/r^3 - A) (q.n) - 12 (1/r^5 - B) (r.q) (r.n)
// In x - i for piece i, x = pieces r^2 - 1/2 within 1/2 of i: coefficients [term, piece].
struct LocalPart {
  int pieces, terms;
  std::vector<double> a, b;
};

// The local part at distances begin ... 1 in float. It falls there by as much as the window of the split, so that float's rounding of
// it, and of r where it is steep, is a small part of the kernel's size at the cutoff. first and second are all that multiplies the tensors:
//   Stokeslet  first f + second r (r.f)      rotlet  second t x r
//   stresslet  first (q (n.r) + n (q.r) + (q.n) r) + second r (q.r) (n.r)
//   pressures  second (r.f)  and  first (q.n) + second (r.q) (r.n)
// Pieces as those of LocalPart, of r^2 from begin^2 to 1: x = to_pieces (r^2 - 1) + pieces - 1/2, exact in float. No terms: there is no
// such distance.
struct OuterPart {
  double begin = 1.0, to_pieces = 0.0;
  int pieces = 0, terms = 0;
  std::vector<double> first, second;
};

class KernelSplit {
 public:
  explicit KernelSplit(double shape) : window_(shape) {}

  double filter(double k) const { return window_.spectrum(k) - 0.5 * k * window_.spectrum_slope(k); }
  LocalPart local_part(std::string_view kernel, double tolerance, int pieces) const;
  // Of at most as many terms.
  OuterPart outer_part(std::string_view kernel, double tolerance, int pieces, int most_terms) const;

 private:
  struct Functions;
  Functions functions(std::string_view kernel) const;
  // Integral over s in [0, 1] of s^power f(r s).
  template <class F>
  static double moment(int power, double r, F const& f);

  KaiserBessel window_;
};

}  // namespace asterflow

#pragma once
// Interpolation of band-limited periodic functions from an oversampled equispaced grid by a compact window,
//   f(x) = sum_j w(x - j) g_j,   w(x) = exp(beta (sqrt(1 - (2 x / W)^2) - 1)),  |x| <= W / 2,
// where the grid values g are those of f with its Fourier coefficients divided by the window's transform. Relative error
// about exp(-pi W sqrt(1 - 1/sigma)) at oversampling sigma; below 10^(1.1 - W) at sigma = 2.
// [Barnett, Magland & af Klinteberg 2019, SIAM J. Sci. Comput. 41]

#include <Eigen/Core>
#include <cmath>

namespace asterflow {

class InterpolationWindow {
 public:
  static constexpr int widths[] = {6, 8, 10, 12, 14, 16};

  InterpolationWindow(int width, double oversampling);  // one of widths; above 1
  static int width_for(double accuracy);                // relative accuracy of the interpolation at oversampling 2

  int width() const { return width_; }
  double transform(double cycles_per_node) const;  // int w(x) cos(2 pi k x) dx

  // Weight of the i-th of the W nodes from the first one: a polynomial in t = 2 z - 1, where z in [0, 1) is the
  // distance from x - W / 2 up to the first node. Column i: coefficients, lowest power first.
  using Coefficients = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;  // [n_coefficient, W]
  Coefficients const& coefficients() const { return coefficients_; }

  // The first of the W nodes around x.
  long first_node(double x) const { return static_cast<long>(std::ceil(x - 0.5 * width_)); }
  // Weights of the W nodes around x, overwritten; returns the first of these nodes. width: W, for the compiler to know.
  long weigh(int width, double x, double* weights) const {
    double const start = x - 0.5 * width, node = std::ceil(start), t = 2.0 * (node - start) - 1.0;
    auto const last = coefficients_.rows() - 1;
    for (int i = 0; i < width; ++i) weights[i] = coefficients_(last, i);
    for (auto k = last - 1; k >= 0; --k)
      for (int i = 0; i < width; ++i) weights[i] = weights[i] * t + coefficients_(k, i);
    return static_cast<long>(node);
  }

 private:
  double value(double x) const;
  int width_;
  double beta_;
  Coefficients coefficients_;
};

}  // namespace asterflow

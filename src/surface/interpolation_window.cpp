#include "surface/interpolation_window.hpp"

#include "base/error.hpp"
#include "linalg/quadrature.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace asterflow {

InterpolationWindow::InterpolationWindow(int width, double oversampling)
    : width_(width), beta_(0.976 * std::numbers::pi * (1.0 - 0.5 / oversampling) * width) {
  ASTERFLOW_REQUIRE(std::ranges::count(widths, width) == 1);
  int const n = width + 4;
  Eigen::MatrixXd powers(n, n), values(n, width);
  for (int k = 0; k < n; ++k) {
    double const t = std::cos(std::numbers::pi * (k + 0.5) / n);
    double power = 1.0;
    for (int j = 0; j < n; ++j, power *= t) powers(k, j) = power;
    for (int i = 0; i < width; ++i) values(k, i) = value(0.5 * (t + 1.0) - 0.5 * width + i);
  }
  coefficients_ = powers.partialPivLu().solve(values);
}

int InterpolationWindow::width_for(double accuracy) {
  for (int const width : widths)
    if (std::pow(10.0, 1.1 - width) <= accuracy) return width;
  return widths[std::size(widths) - 1];
}

double InterpolationWindow::value(double x) const {
  double const y = 2.0 * x / width_;
  return std::abs(y) <= 1.0 ? std::exp(beta_ * (std::sqrt(1.0 - y * y) - 1.0)) : 0.0;
}

double InterpolationWindow::transform(double cycles_per_node) const {
  auto const& gauss = gauss_legendre(100);
  double sum = 0.0;
  for (int i = 0; i < 100; ++i) {
    double const x = 0.5 * width_ * gauss.nodes[i];
    sum += 0.5 * width_ * gauss.weights[i] * value(x) * std::cos(2.0 * std::numbers::pi * cycles_per_node * x);
  }
  return sum;
}

}  // namespace asterflow

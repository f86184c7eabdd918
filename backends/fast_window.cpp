#include "backends/fast_window.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace asterflow {
namespace {

constexpr int most_terms = 400;

// 1 / (n (n + order)) for order 0, 1, 2: divisions would take most of the time of a series.
std::array<std::array<double, most_terms>, 3> const& term_ratios() {
  static auto const ratios = [] {
    std::array<std::array<double, most_terms>, 3> all{};
    for (int order = 0; order < 3; ++order)
      for (int n = 1; n < most_terms; ++n) all[order][n] = 1.0 / (n * static_cast<double>(n + order));
    return all;
  }();
  return ratios;
}

// I_order(z) / z^order by its power series; every term is positive, so nothing cancels.
double scaled_bessel(int order, double z) {
  double term = 1.0;
  for (int i = 1; i <= order; ++i) term /= 2.0 * i;
  double sum = term;
  double const quarter = 0.25 * z * z;
  auto const& ratios = term_ratios()[order];
  for (int n = 1; n < most_terms && term > 1e-18 * sum; ++n) {
    term *= quarter * ratios[n];
    sum += term;
  }
  return sum;
}

}  // namespace

KaiserBessel::KaiserBessel(double shape) : shape_(shape), scale_(shape / (2.0 * std::sinh(shape))) {}

// With s = 1 - x^2:  d/dx = -2 x d/ds  and  d/ds [I_n(c sqrt s) / (c sqrt s)^n] = (c^2 / 2) I_{n+1} / (.)^{n+1}.
double KaiserBessel::value(double x) const {
  return scale_ * scaled_bessel(0, shape_ * std::sqrt(std::max(0.0, 1.0 - x * x)));
}

double KaiserBessel::slope(double x) const {
  double const c2 = shape_ * shape_;
  return -scale_ * c2 * scaled_bessel(1, shape_ * std::sqrt(std::max(0.0, 1.0 - x * x)));
}

double KaiserBessel::slope_of_slope(double x) const {
  double const c2 = shape_ * shape_;
  return scale_ * c2 * c2 * scaled_bessel(2, shape_ * std::sqrt(std::max(0.0, 1.0 - x * x)));
}

double KaiserBessel::spectrum(double k) const {
  double const d = shape_ * shape_ - k * k;
  double const z = std::sqrt(std::abs(d));
  if (z < 1e-4) return 2.0 * scale_ * (1.0 + d / 6.0);
  return 2.0 * scale_ * (d > 0.0 ? std::sinh(z) : std::sin(z)) / z;
}

double KaiserBessel::spectrum_slope(double k) const {
  double const d = shape_ * shape_ - k * k;
  double const z = std::sqrt(std::abs(d));
  if (z < 1e-2) return -2.0 * scale_ * k * (1.0 / 3.0 + d / 30.0 + d * d / 840.0);
  double const by_z = d > 0.0 ? (z * std::cosh(z) - std::sinh(z)) / (z * z * z)
                              : (std::sin(z) - z * std::cos(z)) / (z * z * z);
  return -2.0 * scale_ * k * by_z;
}

}  // namespace asterflow

#include "backends/fast_split.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace asterflow {
namespace {

constexpr int n_quadrature = 36;
constexpr int n_fit = 44;

struct Quadrature {
  std::array<double, n_quadrature> x, w;  // Gauss-Legendre on [0, 1]
};

// Roots of the Legendre polynomial by Newton's method.
Quadrature gauss_legendre() {
  Quadrature q;
  for (int i = 0; i < n_quadrature; ++i) {
    double x = std::cos(M_PI * (i + 0.75) / (n_quadrature + 0.5)), slope = 1.0;
    for (int step = 0; step < 50; ++step) {
      double p0 = 1.0, p1 = x;
      for (int n = 2; n <= n_quadrature; ++n) {
        double const p2 = ((2 * n - 1) * x * p1 - (n - 1) * p0) / n;
        p0 = p1;
        p1 = p2;
      }
      slope = n_quadrature * (x * p1 - p0) / (x * x - 1.0);
      double const change = p1 / slope;
      x -= change;
      if (std::abs(change) < 1e-16) break;
    }
    q.x[i] = 0.5 * (1.0 + x);
    q.w[i] = 1.0 / ((1.0 - x * x) * slope * slope);
  }
  return q;
}

using Function = std::function<double(double)>;

// Chebyshev coefficients in u of f(r), u = 2 r^2 - 1.
std::vector<double> chebyshev_series(Function const& f) {
  std::vector<double> value(n_fit), series(n_fit);
  for (int i = 0; i < n_fit; ++i) value[i] = f(std::sqrt(0.5 + 0.5 * std::cos(M_PI * (i + 0.5) / n_fit)));
  for (int k = 0; k < n_fit; ++k) {
    double sum = 0.0;
    for (int i = 0; i < n_fit; ++i) sum += value[i] * std::cos(M_PI * k * (i + 0.5) / n_fit);
    series[k] = (k == 0 ? 1.0 : 2.0) * sum / n_fit;
  }
  return series;
}

int terms_needed(std::vector<double> const& series, double tolerance) {
  double largest = 0.0;
  for (double a : series) largest = std::max(largest, std::abs(a));
  tolerance = std::max(tolerance, 1e-13 * largest);  // rounding of the coefficients
  double tail = 0.0;
  int n = n_fit;
  while (n > 1 && (tail += std::abs(series[n - 1])) < tolerance) --n;
  return n;
}

// Monomial coefficients of the Chebyshev series cut after n terms, by T_k = 2 u T_{k-1} - T_{k-2}.
std::vector<double> monomials(std::vector<double> const& series, int n) {
  std::vector<double> before(n, 0.0), now(n, 0.0), next(n, 0.0), sum(n, 0.0);
  now[0] = 1.0;
  for (int k = 0; k < n; ++k) {
    for (int i = 0; i < n; ++i) sum[i] += series[k] * now[i];
    for (int i = 0; i < n; ++i) next[i] = (k == 0 ? 1.0 : 2.0) * (i > 0 ? now[i - 1] : 0.0) - (k == 0 ? 0.0 : before[i]);
    before = now;
    now = next;
  }
  return sum;
}

}  // namespace

template <class F>
double KernelSplit::moment(int power, double r, F const& f) {
  static Quadrature const rule = gauss_legendre();
  double sum = 0.0;
  for (int i = 0; i < n_quadrature; ++i) sum += rule.w[i] * std::pow(rule.x[i], power) * f(r * rule.x[i]);
  return sum;
}

LocalPart KernelSplit::local_part(std::string_view kernel, double tolerance) const {
  auto const g = [&](double x) { return window_.value(x); };
  auto const h = [&](double x) { return window_.slope(x); };
  auto const h2 = [&](double x) { return window_.slope_of_slope(x); };
  Function a = [](double) { return 0.0; }, b = a;
  if (kernel == "stokeslet") {
    a = [&](double r) { return 2.0 * g(r) + 2.0 * moment(0, r, g); };
    b = [&](double r) { return -2.0 * moment(2, r, h); };
  } else if (kernel == "rotlet" || kernel == "stokeslet_pressure") {
    b = [&](double r) { return -h(r) - 2.0 * moment(2, r, h); };
  } else if (kernel == "stresslet_pressure") {
    a = [&](double r) { return -h(r) - 2.0 * moment(2, r, h); };
    b = [&](double r) { return (h2(r) + 2.0 * moment(4, r, h2)) / 3.0; };
  } else {
    a = [&](double r) { return 2.0 * h(r); };
    b = [&](double r) { return (2.0 / 3.0) * moment(4, r, h2); };
  }
  auto const series_a = chebyshev_series(a), series_b = chebyshev_series(b);
  int const n = std::max(terms_needed(series_a, tolerance), terms_needed(series_b, tolerance));
  return {monomials(series_a, n), monomials(series_b, n)};
}

}  // namespace asterflow

#include "linalg/quadrature.hpp"

#include "base/error.hpp"

#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <numbers>

namespace asterflow {
namespace {

QuadratureRule compute_gauss_legendre(int n) {
  QuadratureRule rule{std::vector<double>(n), std::vector<double>(n)};
  for (int i = 0; i < (n + 1) / 2; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5)), slope = 1.0;
    for (int iteration = 0; iteration < 8; ++iteration) {
      double p = 1.0, previous = 0.0;
      for (int l = 1; l <= n; ++l) {
        double const next = ((2 * l - 1) * x * p - (l - 1) * previous) / l;
        previous = p;
        p = next;
      }
      slope = n * (previous - x * p) / ((1.0 - x) * (1.0 + x));
      double const change = p / slope;
      x -= change;
      if (std::abs(change) < 1e-16) break;
    }
    if (2 * i + 1 == n) x = 0.0;
    double const weight = 2.0 / ((1.0 - x) * (1.0 + x) * slope * slope);
    rule.nodes[i] = -x;
    rule.nodes[n - 1 - i] = x;
    rule.weights[i] = rule.weights[n - 1 - i] = weight;
  }
  return rule;
}

}  // namespace

QuadratureRule const& gauss_legendre(int n) {
  ASTERFLOW_REQUIRE(n >= 1);
  static std::mutex guard;
  static std::map<int, std::unique_ptr<QuadratureRule const>> rules;
  std::scoped_lock lock(guard);
  auto& rule = rules[n];
  if (!rule) rule = std::make_unique<QuadratureRule const>(compute_gauss_legendre(n));
  return *rule;
}

void legendre_polynomials(double x, int degree, double* values) {
  values[0] = 1.0;
  if (degree >= 1) values[1] = x;
  for (int l = 2; l <= degree; ++l) values[l] = ((2 * l - 1) * x * values[l - 1] - (l - 1) * values[l - 2]) / l;
}

}  // namespace asterflow

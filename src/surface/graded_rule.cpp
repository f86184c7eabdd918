#include "surface/graded_rule.hpp"

#include "linalg/quadrature.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace asterflow {
namespace {

// x = start + direction (map(t)), t in [0, t_last]
void append_stretched(double centre, double direction, double length, double scale, int n, std::vector<RulePoint>& rule) {
  double const t_last = std::asinh(length / scale);
  auto const& gauss = gauss_legendre(n);
  for (int i = 0; i < n; ++i) {
    double const t = 0.5 * t_last * (1.0 + gauss.nodes[i]);
    rule.push_back({centre + direction * scale * std::sinh(t), 0.5 * t_last * gauss.weights[i] * scale * std::cosh(t)});
  }
}

void append_plain(double first, double last, int n, std::vector<RulePoint>& rule) {
  auto const& gauss = gauss_legendre(n);
  for (int i = 0; i < n; ++i)
    rule.push_back({0.5 * (first + last) + 0.5 * (last - first) * gauss.nodes[i], 0.5 * std::abs(last - first) * gauss.weights[i]});
}

// Nodes of a panel per decimal digit: measured, the double layer's error falls twice as fast as these rules' bounds.
void append_side(double centre, double end, double scale, GradedRuleOptions const& options, std::vector<RulePoint>& rule) {
  double const digits = 0.6 * options.digits + 0.5;
  double const length = std::abs(end - centre), direction = end > centre ? 1.0 : -1.0;
  if (length <= 1e-15) return;
  double const smallest = 1e-13 * length;
  scale = std::max(scale, smallest);
  double const inner = std::min(length, std::max(3.0 / options.wavenumber, 0.25 * scale));
  double const ratio = std::asinh(inner / scale);
  int const n_inner = static_cast<int>(std::ceil(digits * (1.0 + 0.16 * ratio) + 3.0 + 0.6 * options.wavenumber * inner));
  append_stretched(centre, direction, inner, scale, n_inner, rule);
  for (double start = inner; start < length * (1.0 - 1e-12);) {  // plain panels, doubling
    double const stop = start * 3.0 >= length ? length : std::min(length, start * 3.0);
    int const n = static_cast<int>(std::ceil(0.85 * digits + 4.0 + 0.6 * options.wavenumber * (stop - start)));
    append_plain(centre + direction * start, centre + direction * stop, n, rule);
    start = stop;
  }
}

}  // namespace

void append_graded_rule(double first, double centre, double last, double scale, GradedRuleOptions const& options,
                        std::vector<RulePoint>& rule) {
  append_side(centre, first, scale, options, rule);
  append_side(centre, last, scale, options, rule);
}

void periodic_rule(double centre, double delta, GradedRuleOptions const& options, std::vector<RulePoint>& rule) {
  constexpr double pi = std::numbers::pi;
  rule.clear();
  if (delta <= 0.3) return append_graded_rule(centre - pi, centre, centre + pi, delta, options, rule);
  int const n = static_cast<int>(std::ceil(options.wavenumber + 1.6 * options.digits / std::min(delta, 10.0))) + 8;
  for (int k = 0; k < n; ++k) rule.push_back({centre + 2.0 * pi * (k + 0.5) / n, 2.0 * pi / n});
}

void half_period_rule(double delta, GradedRuleOptions const& options, std::vector<RulePoint>& rule) {
  constexpr double pi = std::numbers::pi;
  rule.clear();
  if (delta > 0.3) {
    int const n = static_cast<int>(std::ceil(0.5 * (options.wavenumber - 2.0 + 1.6 * options.digits / delta))) + 4;
    for (int k = 0; k < n; ++k) rule.push_back({pi * (k + 0.5) / n, 2.0 * pi / n});
    return;
  }
  append_graded_rule(0.0, 0.0, pi, delta, options, rule);
  for (auto& point : rule) point.weight *= 2.0;
}

}  // namespace asterflow

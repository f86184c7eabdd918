#include "backends/fast_parameters.hpp"

#include <algorithm>
#include <cmath>

namespace asterflow {

// Differentiation costs about a digit.
constexpr double gradient_loss = 0.1;
// Close pairs, which the local part has, are more of a stresslet's flow: so many digits fewer do. In float rounding takes them.
constexpr double stresslet_gain = 0.12;

// Fitted to measured errors of uniform and clustered points, see docs/summation.md.
FastParameters fast_parameters(std::string_view kernel, double accuracy, bool gradient) {
  FastParameters p{};
  double digits = -std::log10(std::clamp(gradient ? gradient_loss * accuracy : accuracy, 1e-12, 1e-3));
  p.single = digits <= 6.05;
  if (kernel == "stresslet" && !p.single && !gradient) digits -= stresslet_gain;
  p.accuracy = accuracy;
  p.band = kernel == "stokeslet" ? 2.36 * digits + 3.0 : 2.5 * digits + (kernel == "stresslet" ? 3.2 : 3.4);
  p.split_shape = p.band - 0.25;
  // A mode near the end of the band carries little, so its alias may lie inside the main lobe of the grid window.
  p.width = static_cast<int>(std::ceil(digits + 0.95));
  double const oversampling = 1.28 - 0.12 * (p.width - digits - 1.0);
  p.window_shape = M_PI * p.width * (0.73 + 0.55 * (oversampling - 1.28));
  p.nodes_per_cutoff = p.band / M_PI * oversampling;
  p.local_tolerance = 0.5 * std::pow(10.0, -digits);
  p.sums_in_double = digits > 4.53;
  p.refinement_steps = p.single ? digits > 3.53 : (digits > 7.0) + (digits > 10.5);
  p.gradient = gradient;
  bool const is_tensor = kernel.starts_with("stresslet");  // six components instead of three
  p.nodes_per_point = p.single ? (is_tensor ? 26.0 : 40.0) : 20.0 * std::max(1.0, std::pow(digits / 6.0, 3));
  p.fewest_nodes = (p.single && p.sums_in_double ? 1e3 : 3.5e4) * p.nodes_per_point;
  return p;
}

double FastParameters::max_nodes(std::size_t n_point) const {
  return std::clamp(nodes_per_point * static_cast<double>(n_point), fewest_nodes, 6.4e7);
}

}  // namespace asterflow

#include "backends/fast_parameters.hpp"

#include <algorithm>
#include <cmath>

namespace asterflow {

// Fitted to measured errors of uniform and clustered points, see docs/summation.md.
FastParameters fast_parameters(std::string_view kernel, double accuracy) {
  double const digits = -std::log10(std::clamp(accuracy, 1e-12, 1e-3));
  constexpr double oversampling = 1.35;
  FastParameters p{};
  p.accuracy = accuracy;
  p.split_shape = kernel == "stokeslet" ? 2.42 * digits + 3.4 : 2.5 * digits + 3.4;
  p.band = p.split_shape;
  p.nodes_per_cutoff = p.band / M_PI * oversampling;
  p.width = static_cast<int>(std::ceil(1.15 * digits + 1.09));
  p.window_shape = M_PI * p.width * (1.0 - 0.5 / oversampling);
  p.local_tolerance = 0.2 * std::pow(10.0, -digits);
  p.single = accuracy >= 3e-5;
  p.refinement_steps = p.single ? (accuracy < 3e-4) : (accuracy < 1e-7);
  return p;
}

}  // namespace asterflow

#include "surface/sphere_grid.hpp"

#include "base/error.hpp"
#include "linalg/quadrature.hpp"

#include <cmath>
#include <numbers>

namespace asterflow {

SphereGrid::SphereGrid(int order, int n_ring) : order_(order), theta_(n_ring), weights_(n_ring) {
  ASTERFLOW_REQUIRE(order >= 1 && n_ring > order);
  auto const& rule = gauss_legendre(n_ring);
  for (int j = 0; j < n_ring; ++j) {
    theta_[j] = std::acos(rule.nodes[n_ring - 1 - j]);
    weights_[j] = rule.weights[n_ring - 1 - j];
  }
}

double SphereGrid::azimuth(int k) const { return 2.0 * std::numbers::pi * k / n_azimuth(); }

}  // namespace asterflow

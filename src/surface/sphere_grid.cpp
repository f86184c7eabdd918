#include "surface/sphere_grid.hpp"

#include "base/error.hpp"
#include "linalg/quadrature.hpp"

#include <cmath>
#include <numbers>

namespace asterflow {

SphereGrid::SphereGrid(int order) : order_(order) {
  ASTERFLOW_REQUIRE(order >= 1);
  auto const& rule = gauss_legendre(order + 1);
  theta_.resize(order + 1);
  weights_.resize(order + 1);
  for (int j = 0; j <= order; ++j) {
    theta_[j] = std::acos(rule.nodes[order - j]);
    weights_[j] = rule.weights[order - j];
  }
}

double SphereGrid::azimuth(int k) const { return 2.0 * std::numbers::pi * k / n_azimuth(); }

}  // namespace asterflow

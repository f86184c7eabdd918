#include "fiber/fiber_basis.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <mutex>

namespace asterflow {

FiberBasis::FiberBasis(int n)
    : n_node(n), n_tangent(n - n / 4), gauss(gauss_rule(n)), lobatto(lobatto_rule(n_tangent)) {
  ASTERFLOW_REQUIRE(n >= min_fiber_nodes && n <= max_fiber_nodes);
  transform = legendre_transform(lobatto);
  tangent = legendre_values(gauss.nodes, n_tangent) * transform;
  position = legendre_integrals(gauss.nodes, n_tangent) * transform;
  derivative = legendre_derivatives(gauss.nodes, n_tangent) * transform;
  bending = derivative.transpose() * gauss.weights.asDiagonal() * derivative;

  // Coefficients of the polynomial through the Gauss nodes, then its integral: total minus integral from 0.
  legendre = legendre_values(gauss.nodes, n);
  Eigen::MatrixXd coefficients = legendre.transpose() * gauss.weights.asDiagonal();
  for (int k = 0; k < n; ++k) coefficients.row(k) *= 2 * k + 1;
  remainder = -legendre_integrals(gauss.nodes, n) * coefficients;
  remainder.rowwise() += gauss.weights.transpose();
  Eigen::MatrixXd const slopes = legendre_derivatives(gauss.nodes, n) * coefficients;
  weak_derivative = -(gauss.weights.cwiseInverse().asDiagonal() * slopes.transpose() * gauss.weights.asDiagonal());
}

FiberBasis const& fiber_basis(int n_node) {
  static std::array<std::unique_ptr<FiberBasis const>, max_fiber_nodes + 1> bases;
  static std::mutex guard;
  ASTERFLOW_REQUIRE(n_node >= min_fiber_nodes && n_node <= max_fiber_nodes);
  std::scoped_lock lock(guard);
  auto& basis = bases[n_node];
  if (!basis) basis = std::make_unique<FiberBasis const>(n_node);
  return *basis;
}

int default_node_count(double length, double accuracy, double persistence) {
  double const digits = -std::log10(std::clamp(accuracy, 1e-12, 0.1));
  double const n = 4.0 + 0.75 * digits * (1.0 + length / (2.0 * persistence));
  int const even = 2 * static_cast<int>(std::ceil(0.5 * n));
  return std::clamp(even, min_fiber_nodes, max_fiber_nodes);
}

}  // namespace asterflow

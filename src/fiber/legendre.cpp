#include "fiber/legendre.hpp"

#include "base/error.hpp"
#include "linalg/quadrature.hpp"

#include <cmath>
#include <numbers>

namespace asterflow {

namespace {

struct LegendrePair {
  double value, before;  // P_n(x), P_{n-1}(x)
};

LegendrePair legendre_pair(int n, double x) {
  double before = 1.0, value = x;
  for (int k = 1; k < n; ++k) {
    double const next = ((2 * k + 1) * x * value - k * before) / (k + 1);
    before = value;
    value = next;
  }
  return {value, before};
}

}  // namespace

UnitRule gauss_rule(int n) {
  auto const& rule = gauss_legendre(n);
  using Map = Eigen::Map<Eigen::VectorXd const>;
  return {0.5 * (1.0 + Map(rule.nodes.data(), n).array()), 0.5 * Map(rule.weights.data(), n)};
}

UnitRule lobatto_rule(int n) {
  ASTERFLOW_REQUIRE(n >= 2);
  UnitRule rule{Eigen::VectorXd(n), Eigen::VectorXd(n)};
  for (int i = 0; i < n; ++i) {
    double x = -std::cos(std::numbers::pi * i / (n - 1));
    for (int iteration = 0; iteration < 20; ++iteration) {  // interior nodes are the roots of P'_{n-1}
      auto const [p, q] = legendre_pair(n - 1, x);
      x -= (x * p - q) / (n * p);
    }
    double const p = legendre_pair(n - 1, x).value;
    rule.nodes[i] = 0.5 * (1 + x);
    rule.weights[i] = 1.0 / (n * (n - 1) * p * p);
  }
  rule.nodes[0] = 0.0;
  rule.nodes[n - 1] = 1.0;
  return rule;
}

Eigen::MatrixXd legendre_values(Eigen::VectorXd const& alpha, int n_degree) {
  Eigen::MatrixXd p(alpha.size(), n_degree);
  Eigen::ArrayXd const x = 2 * alpha.array() - 1;
  if (n_degree > 0) p.col(0).setOnes();
  if (n_degree > 1) p.col(1) = x;
  for (int k = 1; k + 1 < n_degree; ++k)
    p.col(k + 1) = ((2 * k + 1) * x * p.col(k).array() - k * p.col(k - 1).array()) / (k + 1);
  return p;
}

Eigen::MatrixXd legendre_derivatives(Eigen::VectorXd const& alpha, int n_degree) {
  Eigen::MatrixXd const p = legendre_values(alpha, n_degree);
  Eigen::MatrixXd d = Eigen::MatrixXd::Zero(alpha.size(), n_degree);
  if (n_degree > 1) d.col(1).setConstant(2.0);
  for (int k = 1; k + 1 < n_degree; ++k) d.col(k + 1) = d.col(k - 1) + 2 * (2 * k + 1) * p.col(k);
  return d;
}

Eigen::MatrixXd legendre_integrals(Eigen::VectorXd const& alpha, int n_degree) {
  Eigen::MatrixXd const p = legendre_values(alpha, n_degree + 1);
  Eigen::MatrixXd integral(alpha.size(), n_degree);
  if (n_degree > 0) integral.col(0) = alpha;
  for (int k = 1; k < n_degree; ++k) integral.col(k) = (p.col(k + 1) - p.col(k - 1)) / (2 * (2 * k + 1));
  return integral;
}

Eigen::MatrixXd legendre_transform(UnitRule const& lobatto) {
  int const n = static_cast<int>(lobatto.nodes.size());
  Eigen::MatrixXd transform = legendre_values(lobatto.nodes, n).transpose() * lobatto.weights.asDiagonal();
  for (int k = 0; k < n; ++k) transform.row(k) *= k + 1 < n ? 2 * k + 1 : n - 1;  // discrete norms of P_k
  return transform;
}

}  // namespace asterflow

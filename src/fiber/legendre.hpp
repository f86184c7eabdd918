#pragma once
// Legendre polynomials on [0, 1]: nodes, weights, and the evaluation of series and their integrals.
// alpha in [0, 1] is the fraction of a fiber's length, x = 2 alpha - 1 the argument of P_k.

#include <Eigen/Core>

namespace asterflow {

// Nodes and weights of a rule on [0, 1], both [n]; the weights sum to 1.
struct UnitRule {
  Eigen::VectorXd nodes, weights;
};

UnitRule gauss_rule(int n);    // interior nodes, exact to degree 2 n - 1
UnitRule lobatto_rule(int n);  // with both ends, n >= 2, exact to degree 2 n - 3

// Values at the points of all polynomials of degree < n_degree: [n_point, n_degree]
Eigen::MatrixXd legendre_values(Eigen::VectorXd const& alpha, int n_degree);
// d/d alpha of the same
Eigen::MatrixXd legendre_derivatives(Eigen::VectorXd const& alpha, int n_degree);
// integral from 0 to alpha of the same
Eigen::MatrixXd legendre_integrals(Eigen::VectorXd const& alpha, int n_degree);
// Coefficients of the polynomial that takes given values at the nodes of lobatto_rule(n): [n, n]
Eigen::MatrixXd legendre_transform(UnitRule const& lobatto);

}  // namespace asterflow

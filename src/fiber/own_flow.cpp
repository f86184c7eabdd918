#include "fiber/own_flow.hpp"

#include "base/rigid.hpp"
#include "fiber/centreline.hpp"
#include "kernels/stokeslet.hpp"

#include <algorithm>

namespace asterflow {
namespace {

// Values g at the Gauss nodes -> int (g(s') - g(s)) / |s - s'| ds' there; 2 H_k up to `largest`.
Eigen::MatrixXd finite_part(FiberBasis const& basis, double largest) {
  int const n = basis.n_node;
  Eigen::VectorXd factors(n);
  double harmonic = 0.0;
  for (int k = 0; k < n; ++k) {
    if (k > 0) harmonic += 1.0 / k;
    factors[k] = -std::min(2.0 * harmonic, largest) * (2 * k + 1);
  }
  return basis.legendre * factors.asDiagonal() * basis.legendre.transpose() * basis.gauss.weights.asDiagonal();
}

}  // namespace

void OwnFlow::prepare(FiberBasis const& basis, Centreline const& shape, ConstPoints nodes, double mobility,
                      double viscosity) {
  int const n = basis.n_node;
  double const scale = Stokeslet::prefactor / viscosity;
  Eigen::MatrixXd const integral = finite_part(basis, std::max(mobility / scale - 1.0, 0.0));
  matrix_.resize(3 * n, 3 * n);
  for (int i = 0; i < n; ++i) {
    Vec3d tangent;
    for (int j = 0; j < basis.n_tangent; ++j) tangent += basis.tangent(i, j) * shape.tangents[j];
    tangent = normalized(tangent);
    for (int j = 0; j < n; ++j) {
      double const arc = shape.length * std::abs(basis.gauss.nodes[i] - basis.gauss.nodes[j]);
      for (int k = 0; k < 3; ++k) {
        Vec3d e, column;
        e[k] = 1.0;
        if (i == j)
          column = scale * ((2.0 + integral(i, i)) * e + ((integral(i, i) - 2.0) * tangent[k]) * tangent);
        else
          column = (integral(i, j) * arc / viscosity) * Stokeslet::velocity(nodes[i] - nodes[j], e);
        matrix_.col(3 * j + k).segment<3>(3 * i) = to_eigen(column);
      }
    }
  }
}

void OwnFlow::add(ConstPoints f, Points u) const { flat(u).noalias() += matrix_ * flat(f); }

}  // namespace asterflow

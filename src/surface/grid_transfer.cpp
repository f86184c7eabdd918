#include "surface/grid_transfer.hpp"

#include <algorithm>
#include <cmath>

namespace asterflow {
namespace {

// Real orthonormal spherical harmonics of degree <= order at all nodes: [size, (order + 1)^2].
Eigen::MatrixXd harmonics(SphereGrid const& grid, int order) {
  Eigen::MatrixXd y(grid.size(), (order + 1) * (order + 1));
  int const n_azimuth = grid.n_azimuth();
  for (int j = 0; j < grid.n_ring(); ++j)
    for (int l = 0, column = 0; l <= order; ++l)
      for (int m = -l; m <= l; ++m, ++column) {
        double const p = std::sph_legendre(l, std::abs(m), grid.polar_angles()[j]) * (m == 0 ? 1.0 : std::sqrt(2.0));
        for (int k = 0; k < n_azimuth; ++k) {
          double const phi = std::abs(m) * grid.azimuth(k);
          y(j * n_azimuth + k, column) = p * (m < 0 ? std::sin(phi) : std::cos(phi));
        }
      }
  return y;
}

}  // namespace

Eigen::MatrixXd grid_transfer(SphereGrid const& from, SphereGrid const& to) {
  int const order = std::min(from.order(), to.order());
  Eigen::VectorXd weights(from.size());
  for (int j = 0; j < from.n_ring(); ++j)
    weights.segment(j * from.n_azimuth(), from.n_azimuth()).setConstant(from.ring_weights()[j] * 2 * M_PI / from.n_azimuth());
  return harmonics(to, order) * (harmonics(from, order).transpose() * weights.asDiagonal());
}

}  // namespace asterflow

#include "surface/sphere_grid.hpp"

#include "linalg/quadrature.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace asterflow;

TEST(SphereGrid, integrates_polynomials_of_degree_2p_plus_1_exactly) {
  int const p = 7;
  SphereGrid const grid(p);
  double sum = 0.0;  // of z^8 x^2 y^4, degree 14
  for (int j = 0; j < grid.n_ring(); ++j)
    for (int k = 0; k < grid.n_azimuth(); ++k) {
      double const t = grid.polar_angles()[j], f = grid.azimuth(k);
      double const x = std::sin(t) * std::cos(f), y = std::sin(t) * std::sin(f), z = std::cos(t);
      sum += grid.ring_weights()[j] * 2.0 * std::numbers::pi / grid.n_azimuth() * std::pow(z, 8) * x * x * std::pow(y, 4);
    }
  // int z^8 x^2 y^4 = 4 pi (7!! 1!! 3!!) / 15!!
  EXPECT_NEAR(sum, 4.0 * std::numbers::pi * (105.0 * 1.0 * 3.0) / 2027025.0, 1e-15);
}

TEST(SphereGrid, polar_angles_ascend_and_weights_sum_to_two) {
  SphereGrid const grid(20);
  double sum = 0.0;
  for (int j = 0; j < grid.n_ring(); ++j) {
    sum += grid.ring_weights()[j];
    if (j > 0) {
      EXPECT_GT(grid.polar_angles()[j], grid.polar_angles()[j - 1]);
    }
  }
  EXPECT_NEAR(sum, 2.0, 1e-14);
}

TEST(Quadrature, gauss_legendre_is_exact_to_degree_2n_minus_1) {
  for (int const n : {1, 2, 5, 16, 64}) {
    auto const& rule = gauss_legendre(n);
    double sum = 0.0;
    for (int i = 0; i < n; ++i) sum += rule.weights[i] * std::pow(rule.nodes[i], 2 * n - 2);
    EXPECT_NEAR(sum, 2.0 / (2 * n - 1), 1e-14) << n;
  }
}

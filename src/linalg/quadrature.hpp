#pragma once
// Gauss-Legendre quadrature and Legendre polynomials on [-1, 1].

#include <vector>

namespace asterflow {

// Exact for polynomials of degree 2 n - 1; nodes ascend.
struct QuadratureRule {
  std::vector<double> nodes;    // [n]
  std::vector<double> weights;  // [n]
};

// n >= 1. Newton's method from Tricomi's estimate, weights to rounding. Rules are cached, the reference stays valid.
QuadratureRule const& gauss_legendre(int n);

// values[l] = P_l(x), l = 0 ... degree, by the three-term recurrence.
void legendre_polynomials(double x, int degree, double* values);

}  // namespace asterflow

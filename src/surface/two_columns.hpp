#pragma once
// result = a x for two columns x, real and imaginary part of modes: a large matrix a is read once, four of its columns at a time.

#include <Eigen/Core>
#include <algorithm>

namespace asterflow {

template <class Real>
using TwoColumns = Eigen::Matrix<Real, Eigen::Dynamic, 2>;

template <class Real>
void multiply(Eigen::MatrixX<Real> const& a, TwoColumns<Real> const& x, TwoColumns<Real>& result) {
  result.setZero(a.rows(), 2);
  Eigen::Index const n = a.rows();
  Real* const re = result.col(0).data();
  Real* const im = result.col(1).data();
  for (Eigen::Index j = 0; j < a.cols(); j += 4) {
    Real const* column[4];
    Real x_re[4], x_im[4];
    for (int k = 0; k < 4; ++k) {
      Eigen::Index const c = std::min(j + k, a.cols() - 1);
      column[k] = a.col(c).data();
      x_re[k] = j + k < a.cols() ? x(c, 0) : Real(0);
      x_im[k] = j + k < a.cols() ? x(c, 1) : Real(0);
    }
    for (Eigen::Index i = 0; i < n; ++i) {
      Real const a0 = column[0][i], a1 = column[1][i], a2 = column[2][i], a3 = column[3][i];
      re[i] += a0 * x_re[0] + a1 * x_re[1] + a2 * x_re[2] + a3 * x_re[3];
      im[i] += a0 * x_im[0] + a1 * x_im[1] + a2 * x_im[2] + a3 * x_im[3];
    }
  }
}

}  // namespace asterflow

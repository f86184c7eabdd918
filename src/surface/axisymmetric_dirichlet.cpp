#include "surface/axisymmetric_dirichlet.hpp"

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "surface/two_columns.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace asterflow {
namespace {

using Eigen::MatrixXd;

constexpr double rough_accuracy = 1e-4;

double quadrature_digits(double accuracy) { return std::clamp(1.5 - std::log10(accuracy), 4.0, 13.0); }

}  // namespace

AxisymmetricDirichlet::AxisymmetricDirichlet(Surface const& surface, Side side, int n_shell, double accuracy,
                                             Matrices matrices)
    : surface_(surface), side_(side), transform_(surface.grid().n_azimuth()), n_shell_(n_shell),
      n_ring_(surface.grid().n_ring()), n_mode_(surface.grid().n_mode()), matrices_(std::move(matrices)) {
  if (matrices_.empty()) assemble(accuracy);
}

void AxisymmetricDirichlet::assemble(double accuracy) {
  ModalBoundary const boundary(surface_, side_, quadrature_digits(accuracy));
  matrices_.assign(n_mode_ + (side_ == Side::exterior ? 2 : 0), {});
  assemble_shells(boundary);
  parallel_for("AxisymmetricDirichlet::solve", n_mode_, [&](long m) {
    Eigen::PartialPivLU<MatrixXd> const inverse(boundary.equation(static_cast<int>(m)).transpose());
    MatrixXd& shells = matrices_[m];
    shells = inverse.solve(shells.transpose()).transpose();
    shells.topRows(3 * n_ring_).setIdentity();  // shell 0 is the surface: exactly the boundary data
    if (side_ == Side::exterior && m < 2)
      matrices_[n_mode_ + m] = inverse.solve(boundary.load_of_density(static_cast<int>(m)).transpose()).transpose();
  });
  for (int m = 0; m < n_mode_; ++m) matrices_[m] = matrices_[m].topRows(shells_above(m, 0.1 * accuracy) * 3 * n_ring_).eval();
}

long AxisymmetricDirichlet::shells_above(int m, double size) const {
  long kept = matrices_[m].rows() / (3 * n_ring_);
  while (kept > 1 && matrices_[m].middleRows((kept - 1) * 3 * n_ring_, 3 * n_ring_).lpNorm<Eigen::Infinity>() < size) --kept;
  return kept;
}

// Velocity on the shells of the density itself; solved for boundary data by the caller.
void AxisymmetricDirichlet::assemble_shells(ModalBoundary const& boundary) {
  for (int m = 0; m < n_mode_; ++m) matrices_[m].setZero(3 * n_shell_ * n_ring_, 3 * n_ring_);
  ModalBoundary::LoadRows const loads[2] = {boundary.load_of_density(0), boundary.load_of_density(1)};
  double const shift = boundary.surface().to_polar(boundary.surface().shape().centre()).x;
  long const n_inner = static_cast<long>(n_shell_ - 1) * n_ring_;
  parallel_for("AxisymmetricDirichlet::shells", n_inner, [&](long i) {
    int const k = 1 + static_cast<int>(i / n_ring_), j = static_cast<int>(i % n_ring_);
    bool const is_infinity = side_ == Side::exterior && k == n_shell_ - 1;
    double const scale = is_infinity ? 1.0 : shell_scale(k, n_shell_), factor = side_ == Side::interior ? 1.0 : 1.0 / scale;
    CylindricalPoint const arm = boundary.ring(j);
    double const rho = side_ == Side::interior ? scale : 1.0 / scale;  // infinity: that of the surface
    CylindricalPoint const x{rho * arm.z, rho * arm.r};
    ModalRowSet const set = is_infinity ? ModalRowSet() : boundary.rows().at({x.z + shift, x.r});
    for (int m = 0; m < n_mode_; ++m) {
      Eigen::Matrix<double, 3, Eigen::Dynamic> velocity = Eigen::Matrix<double, 3, Eigen::Dynamic>::Zero(3, 3 * n_ring_);
      if (!is_infinity) velocity = set[m];
      if (side_ == Side::exterior && m < 2) {
        Eigen::Matrix<double, 3, 2> u = modal_velocity_of_load(m, x);
        if (is_infinity) u.col(1).setZero();  // the Stokeslet alone falls as s
        velocity += u * loads[m];
      }
      for (int c = 0; c < 3; ++c) matrices_[m].row((k * 3 + c) * n_ring_ + j) = factor * velocity.row(c);
    }
  });
}

template <class Real>
void AxisymmetricDirichlet::apply(std::vector<Eigen::MatrixX<Real>> const& matrices, ConstPoints boundary_velocity,
                                  std::vector<ShellMode<Real>>& modes) const {
  std::vector<RingMode> const boundary = analyse_modes(surface_, transform_, boundary_velocity);
  modes.resize(n_mode_);
  parallel_for("AxisymmetricDirichlet::shell_modes", n_mode_,
               [&](long m) { multiply<Real>(matrices[m], boundary[m].cast<Real>(), modes[m]); });
}

void AxisymmetricDirichlet::shell_modes(ConstPoints boundary_velocity, std::vector<ShellMode<double>>& modes) const {
  apply(matrices_, boundary_velocity, modes);
}

void AxisymmetricDirichlet::shell_modes(ConstPoints boundary_velocity, std::vector<ShellMode<float>>& modes) const {
  if (rough_.empty())
    for (int m = 0; m < n_mode_; ++m)
      rough_.push_back(matrices_[m].topRows(shells_above(m, rough_accuracy) * 3 * n_ring_).cast<float>());
  apply(rough_, boundary_velocity, modes);
}

std::size_t AxisymmetricDirichlet::memory() const {
  std::size_t bytes = ShellOperator::memory();
  for (auto const& matrix : rough_) bytes += sizeof(float) * static_cast<std::size_t>(matrix.size());
  return bytes;
}

Eigen::Matrix<double, 6, 1> AxisymmetricDirichlet::load(ConstPoints boundary_velocity) const {
  ASTERFLOW_REQUIRE(side_ == Side::exterior);
  std::vector<RingMode> const boundary = analyse_modes(surface_, transform_, boundary_velocity);
  return ModalBoundary::load(matrices_[n_mode_] * boundary[0], matrices_[n_mode_ + 1] * boundary[1]);
}

}  // namespace asterflow

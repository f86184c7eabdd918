#include "surface/axisymmetric_dirichlet.hpp"

#include "base/error.hpp"
#include "base/parallel.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace asterflow {
namespace {

using Eigen::MatrixXd;
using LoadVelocity = Eigen::Matrix<double, 3, 2>;
constexpr double pi = std::numbers::pi;

// Velocity at (z, r) from the centre of a unit force and a unit torque there: along e_1 (m = 0), or along
// (e_2 + i e_3) and (e_3 - i e_2) (m = 1), in the components of modal_rows.hpp.
LoadVelocity velocity_of_load(int m, CylindricalPoint x) {
  double const inverse = 1.0 / std::hypot(x.z, x.r), cube = inverse * inverse * inverse;
  LoadVelocity u;
  if (m == 0)
    u << inverse + x.z * x.z * cube, 0.0, x.z * x.r * cube, 0.0, 0.0, x.r * cube;
  else
    u << x.z * x.r * cube, -x.r * cube, inverse + x.r * x.r * cube, x.z * cube, inverse, x.z * cube;
  return u / (8.0 * pi);
}

// result = a x for two columns, reading a once, four of its columns at a time.
void multiply(MatrixXd const& a, Eigen::Matrix<double, Eigen::Dynamic, 2> const& x, ShellMode& result) {
  result.setZero(a.rows(), 2);
  Eigen::Index const n = a.rows();
  double* const re = result.col(0).data();
  double* const im = result.col(1).data();
  for (Eigen::Index j = 0; j < a.cols(); j += 4) {
    double const* column[4];
    double x_re[4], x_im[4];
    for (int k = 0; k < 4; ++k) {
      Eigen::Index const c = std::min(j + k, a.cols() - 1);
      column[k] = a.col(c).data();
      x_re[k] = j + k < a.cols() ? x(c, 0) : 0.0;
      x_im[k] = j + k < a.cols() ? x(c, 1) : 0.0;
    }
    for (Eigen::Index i = 0; i < n; ++i) {
      double const a0 = column[0][i], a1 = column[1][i], a2 = column[2][i], a3 = column[3][i];
      re[i] += a0 * x_re[0] + a1 * x_re[1] + a2 * x_re[2] + a3 * x_re[3];
      im[i] += a0 * x_im[0] + a1 * x_im[1] + a2 * x_im[2] + a3 * x_im[3];
    }
  }
}

}  // namespace

AxisymmetricDirichlet::AxisymmetricDirichlet(Surface const& surface, Side side, int n_shell, double accuracy)
    : surface_(surface), side_(side), n_shell_(n_shell), n_ring_(surface.grid().n_ring()),
      transform_(surface.grid().n_azimuth()) {
  ASTERFLOW_REQUIRE(surface.axisymmetric());
  ModalRows const rows(surface_, std::clamp(1.5 - std::log10(accuracy), 4.0, 13.0));
  std::vector<ModalRowSet> rings(n_ring_);
  parallel_for("AxisymmetricDirichlet::rings", n_ring_,
               [&](long j) { rings[j] = rows.on_surface(surface_.grid().polar_angles()[j]); });
  assemble_shells(rows);
  load_operators_.resize(side == Side::exterior ? 2 : 0);
  parallel_for("AxisymmetricDirichlet::solve", n_ring_, [&](long m) {
    Eigen::PartialPivLU<MatrixXd> const inverse(boundary_operator(static_cast<int>(m), rings).transpose());
    MatrixXd& shells = shell_operators_[m];
    shells = inverse.solve(shells.transpose()).transpose();
    shells.topRows(3 * n_ring_).setIdentity();  // shell 0 is the surface: exactly the boundary data
    if (side_ == Side::exterior && m < 2)
      load_operators_[m] = inverse.solve(load_of_density(static_cast<int>(m)).transpose()).transpose();
  });
  drop_negligible_shells(accuracy);
}

void AxisymmetricDirichlet::drop_negligible_shells(double accuracy) {
  for (MatrixXd& shells : shell_operators_) {
    int kept = n_shell_;
    while (kept > 1 && shells.middleRows((kept - 1) * 3 * n_ring_, 3 * n_ring_).lpNorm<Eigen::Infinity>() < 0.1 * accuracy)
      --kept;
    shells = shells.topRows(kept * 3 * n_ring_).eval();
  }
}

CylindricalPoint AxisymmetricDirichlet::shell_node(int ring, int shell) const {
  double const scale = shell_scale(shell, n_shell_);
  Vec3d const point = surface_.patch(surface_.grid().polar_angles()[ring], 0.0).position;
  Vec3d const arm = surface_.to_polar(point - surface_.shape().centre());
  double const rho = side_ == Side::interior ? scale : 1.0 / scale;
  return {rho * arm.x, rho * arm.y};
}

// Rows of force and torque in the density of mode m, see the header.
AxisymmetricDirichlet::LoadRows AxisymmetricDirichlet::load_of_density(int m) const {
  LoadRows rows = LoadRows::Zero(2, 3 * n_ring_);
  double const factor = -2.0 / std::sqrt(surface_.area() / (4.0 * pi));
  for (int j = 0; j < n_ring_; ++j) {
    auto const node = static_cast<std::size_t>(j) * surface_.grid().n_azimuth();
    double const weight = factor * surface_.weights()[node] * surface_.grid().n_azimuth();  // the whole ring
    CylindricalPoint const y = shell_node(j, 0);
    if (m == 0) {
      rows(0, j) = weight;
      rows(1, 2 * n_ring_ + j) = weight * y.r;
    } else {
      for (int c : {1, 2}) rows(0, c * n_ring_ + j) = 0.5 * weight;
      for (int c : {1, 2}) rows(1, c * n_ring_ + j) = 0.5 * weight * y.z;
      rows(1, j) = -0.5 * weight * y.r;
    }
  }
  return rows;
}

MatrixXd AxisymmetricDirichlet::boundary_operator(int m, std::vector<ModalRowSet> const& rings) const {
  MatrixXd a(3 * n_ring_, 3 * n_ring_);
  for (int c = 0; c < 3; ++c)
    for (int j = 0; j < n_ring_; ++j) a.row(c * n_ring_ + j) = rings[j][m].row(c);
  a.diagonal().array() += side_ == Side::interior ? 0.5 : -0.5;
  if (side_ == Side::interior && m == 0) {
    Eigen::VectorXd normal = Eigen::VectorXd::Zero(3 * n_ring_), flux = normal;
    for (int j = 0; j < n_ring_; ++j) {
      auto const node = static_cast<std::size_t>(j) * surface_.grid().n_azimuth();
      Vec3d const n = surface_.to_polar(surface_.normals()[node]);
      for (int c = 0; c < 2; ++c) {
        normal[c * n_ring_ + j] = n[c];
        flux[c * n_ring_ + j] = n[c] * surface_.weights()[node] * surface_.grid().n_azimuth() / surface_.area();
      }
    }
    a += normal * flux.transpose();
  }
  if (side_ == Side::exterior && m < 2) {
    LoadRows const loads = load_of_density(m);
    for (int j = 0; j < n_ring_; ++j) {
      LoadVelocity const u = velocity_of_load(m, shell_node(j, 0));
      for (int c = 0; c < 3; ++c) a.row(c * n_ring_ + j) += u.row(c) * loads;
    }
  }
  return a;
}

// Velocity on the shells of the density itself; solved for boundary data by the caller.
void AxisymmetricDirichlet::assemble_shells(ModalRows const& rows) {
  shell_operators_.assign(n_ring_, MatrixXd::Zero(3 * n_shell_ * n_ring_, 3 * n_ring_));
  LoadRows const loads[2] = {load_of_density(0), load_of_density(1)};
  double const shift = surface_.to_polar(surface_.shape().centre()).x;
  long const n_inner = static_cast<long>(n_shell_ - 1) * n_ring_;
  parallel_for("AxisymmetricDirichlet::shells", n_inner, [&](long i) {
    int const k = 1 + static_cast<int>(i / n_ring_), j = static_cast<int>(i % n_ring_);
    bool const is_infinity = side_ == Side::exterior && k == n_shell_ - 1;
    double const scale = side_ == Side::interior ? 1.0 : (is_infinity ? 1.0 : 1.0 / shell_scale(k, n_shell_));
    CylindricalPoint const x = shell_node(j, is_infinity ? 0 : k);
    ModalRowSet const set = is_infinity ? ModalRowSet() : rows.at({x.z + shift, x.r});
    for (int m = 0; m < n_ring_; ++m) {
      Eigen::Matrix<double, 3, Eigen::Dynamic> velocity = Eigen::Matrix<double, 3, Eigen::Dynamic>::Zero(3, 3 * n_ring_);
      if (!is_infinity) velocity = set[m];
      if (side_ == Side::exterior && m < 2) {
        LoadVelocity u = velocity_of_load(m, x);
        if (is_infinity) u.col(1).setZero();  // the Stokeslet alone falls as s
        velocity += u * loads[m];
      }
      for (int c = 0; c < 3; ++c) shell_operators_[m].row((k * 3 + c) * n_ring_ + j) = scale * velocity.row(c);
    }
  });
}

std::vector<AxisymmetricDirichlet::BoundaryMode> AxisymmetricDirichlet::boundary_modes(ConstPoints velocity) const {
  ASTERFLOW_REQUIRE(velocity.size() == surface_.size());
  auto const& grid = surface_.grid();
  int const n = grid.n_azimuth();
  std::vector<BoundaryMode> modes(n_ring_, BoundaryMode(3 * n_ring_, 2));
  std::vector<double> values(3 * n);
  std::vector<std::complex<double>> coefficients(n / 2 + 1);
  for (int j = 0; j < n_ring_; ++j) {
    for (int k = 0; k < n; ++k) {
      Vec3d const w = surface_.to_polar(velocity[static_cast<std::size_t>(j) * n + k]);
      double const c = std::cos(grid.azimuth(k)), s = std::sin(grid.azimuth(k));
      values[k] = w.x;
      values[n + k] = c * w.y + s * w.z;
      values[2 * n + k] = c * w.z - s * w.y;
    }
    for (int c = 0; c < 3; ++c) {
      transform_.analyse(values.data() + c * n, coefficients.data());
      for (int m = 0; m < n_ring_; ++m) {
        auto const f = c < 2 ? coefficients[m] : coefficients[m] * std::complex(0.0, -1.0);
        modes[m].row(c * n_ring_ + j) << f.real(), f.imag();
      }
    }
  }
  return modes;
}

void AxisymmetricDirichlet::shell_modes(ConstPoints boundary_velocity, std::vector<ShellMode>& modes) const {
  std::vector<BoundaryMode> const boundary = boundary_modes(boundary_velocity);
  modes.resize(n_ring_);
  parallel_for("AxisymmetricDirichlet::shell_modes", n_ring_,
               [&](long m) { multiply(shell_operators_[m], boundary[m], modes[m]); });
}

Eigen::Matrix<double, 6, 1> AxisymmetricDirichlet::load(ConstPoints boundary_velocity) const {
  ASTERFLOW_REQUIRE(side_ == Side::exterior);
  std::vector<BoundaryMode> const boundary = boundary_modes(boundary_velocity);
  Eigen::Matrix2d const axial = load_operators_[0] * boundary[0], transverse = load_operators_[1] * boundary[1];
  Eigen::Matrix<double, 6, 1> load;  // rows of the above: force, torque; columns: real, imaginary
  load << axial(0, 0), 2.0 * transverse(0, 0), -2.0 * transverse(0, 1),  //
      -axial(1, 1), 2.0 * transverse(1, 1), 2.0 * transverse(1, 0);
  return load;
}

std::size_t AxisymmetricDirichlet::memory() const {
  std::size_t bytes = 0;
  for (auto const& a : shell_operators_) bytes += sizeof(double) * a.size();
  return bytes;
}

}  // namespace asterflow

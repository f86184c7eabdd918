#pragma once
// Solution operator of the Stokes-Dirichlet problem inside or outside an axisymmetric surface, mode by mode in azimuth:
// boundary velocity -> velocity on shells (shell_table.hpp). The unknown is a double-layer density q,
//   interior  (1/2 + D) q + n int q.n dS / area = w               (the flux, one-dimensional null space, is completed)
//   exterior (-1/2 + D) q + Stokeslet(F) + rotlet(T) = w,  F = -2/l int q dS, T = -2/l int (y - centre) x q dS,
// l^2 = area / (4 pi)  [Power & Miranda 1987]. F and T are force and torque on the fluid, viscosity 1.
// Exterior shell values are velocity / s, s = 1/rho, finite at infinity.

#include "surface/modal_rows.hpp"
#include "surface/shell_table.hpp"

namespace asterflow {

enum class Side { interior, exterior };

class AxisymmetricDirichlet {
 public:
  // Modes are left out on shells where they are below `accuracy` of their boundary values.
  AxisymmetricDirichlet(Surface const& surface, Side side, int n_shell, double accuracy);

  // Coefficients of all modes on all shells; overwrites.
  void shell_modes(ConstPoints boundary_velocity, std::vector<ShellMode>& modes) const;
  // Exterior: force and torque about the centre, along (e_1, e_2, e_3), viscosity 1.
  Eigen::Matrix<double, 6, 1> load(ConstPoints boundary_velocity) const;
  std::size_t memory() const;  // bytes

 private:
  using LoadRows = Eigen::Matrix<double, 2, Eigen::Dynamic>;  // force, torque
  using BoundaryMode = Eigen::Matrix<double, Eigen::Dynamic, 2>;  // [3 n_ring] real and imaginary part

  std::vector<BoundaryMode> boundary_modes(ConstPoints boundary_velocity) const;
  CylindricalPoint shell_node(int ring, int shell) const;
  LoadRows load_of_density(int m) const;  // modes 0 (axial) and 1 (transverse)
  Eigen::MatrixXd boundary_operator(int m, std::vector<ModalRowSet> const& rings) const;
  void assemble_shells(ModalRows const& rows);
  void drop_negligible_shells(double accuracy);

  Surface surface_;
  Side side_;
  int n_shell_, n_ring_;
  AzimuthTransform transform_;
  std::vector<Eigen::MatrixXd> shell_operators_;  // [mode] (kept shells * 3 n_ring) x (3 n_ring)
  std::vector<LoadRows> load_operators_;          // [mode 0, 1]
};

}  // namespace asterflow

#pragma once
// Solution operator of the Stokes-Dirichlet problem inside or outside an axisymmetric surface (modal_boundary.hpp):
// boundary velocity -> velocity on shells (shell_table.hpp), mode by mode in azimuth.
// Exterior shell values are velocity / s, s = 1/rho, finite at infinity.

#include "surface/modal_boundary.hpp"
#include "surface/shell_table.hpp"

namespace asterflow {

class AxisymmetricDirichlet {
 public:
  // Keeps a reference to the surface. Modes are left out on shells where they are below `accuracy` of their boundary values.
  AxisymmetricDirichlet(Surface const& surface, Side side, int n_shell, double accuracy);

  // Coefficients of all modes on all shells; overwrites.
  void shell_modes(ConstPoints boundary_velocity, std::vector<ShellMode>& modes) const;
  // Exterior: force and torque about the centre, along (e_1, e_2, e_3), viscosity 1.
  Eigen::Matrix<double, 6, 1> load(ConstPoints boundary_velocity) const;
  std::size_t memory() const;  // bytes

 private:
  CylindricalPoint shell_node(int ring, int shell) const;  // from the centre
  void assemble_shells();
  void drop_negligible_shells(double accuracy);

  ModalBoundary boundary_;
  int n_shell_, n_ring_;
  std::vector<Eigen::MatrixXd> shell_operators_;         // [mode] (kept shells * 3 n_ring) x (3 n_ring)
  std::vector<ModalBoundary::LoadRows> load_operators_;  // [mode 0, 1] of boundary velocity
};

}  // namespace asterflow

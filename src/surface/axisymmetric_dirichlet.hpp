#pragma once
// Solution operator (shell_operator.hpp) of an axisymmetric surface, mode by mode in azimuth (modal_boundary.hpp).

#include "surface/modal_boundary.hpp"
#include "surface/shell_table.hpp"

namespace asterflow {

class AxisymmetricDirichlet : public ShellOperator {
 public:
  // Keeps a reference to the surface. Modes are left out on shells where they are below `accuracy` of their boundary values.
  AxisymmetricDirichlet(Surface const& surface, Side side, int n_shell, double accuracy);

  void shell_modes(ConstPoints boundary_velocity, std::vector<ShellMode>& modes) const override;
  Eigen::Matrix<double, 6, 1> load(ConstPoints boundary_velocity) const override;
  std::size_t memory() const override;

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

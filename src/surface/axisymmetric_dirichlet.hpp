#pragma once
// Solution operator (shell_operator.hpp) of an axisymmetric surface, mode by mode in azimuth (modal_boundary.hpp).

#include "surface/modal_boundary.hpp"
#include "surface/shell_table.hpp"

namespace asterflow {

class AxisymmetricDirichlet : public ShellOperator {
 public:
  // Keeps a reference to the surface. Modes are left out on shells where they are below `accuracy` of their boundary values.
  // With `matrices` of an equal operator nothing is computed.
  AxisymmetricDirichlet(Surface const& surface, Side side, int n_shell, double accuracy, Matrices matrices);

  void shell_modes(ConstPoints boundary_velocity, std::vector<ShellMode<double>>& modes) const override;
  void shell_modes(ConstPoints boundary_velocity, std::vector<ShellMode<float>>& modes) const override;
  Eigen::Matrix<double, 6, 1> load(ConstPoints boundary_velocity) const override;
  Matrices const& matrices() const override { return matrices_; }
  std::size_t memory() const override;

 private:
  template <class Real>
  void apply(std::vector<Eigen::MatrixX<Real>> const& matrices, ConstPoints boundary_velocity,
             std::vector<ShellMode<Real>>& modes) const;
  void assemble(double accuracy);
  void assemble_shells(ModalBoundary const& boundary);
  long shells_above(int mode, double size) const;  // up to the last that has an entry above it

  Surface const& surface_;
  Side side_;
  AzimuthTransform transform_;
  int n_shell_, n_ring_, n_mode_;
  // [mode] (kept shells * 3 n_ring) x (3 n_ring); then, exterior, of modes 0 and 1: load of boundary velocity, 2 x (3 n_ring)
  Matrices matrices_;
  mutable std::vector<Eigen::MatrixXf> rough_;  // of each mode, fewer shells; made when it is first wanted
};

}  // namespace asterflow

#pragma once
// Solution operator (shell_operator.hpp) of a triaxial ellipsoid; equation as in modal_boundary.hpp, rows of
// general_rows.hpp. Its three mirror planes split it into eight dense blocks (mirror_classes.hpp): with N nodes and n
// shells they take about 1.1 n N^2 numbers, 0.3 GB for 1250 nodes.

#include "surface/mirror_classes.hpp"
#include "surface/shell_operator.hpp"

namespace asterflow {

class GeneralDirichlet : public ShellOperator {
 public:
  // Keeps a reference to the surface. With `matrices` of an equal operator nothing is computed.
  GeneralDirichlet(Surface const& surface, Side side, int n_shell, double accuracy, Matrices matrices);

  void shell_modes(ConstPoints boundary_velocity, std::vector<ShellMode<double>>& modes) const override;
  void shell_modes(ConstPoints boundary_velocity, std::vector<ShellMode<float>>& modes) const override;
  Eigen::Matrix<double, 6, 1> load(ConstPoints boundary_velocity) const override;
  Matrices const& matrices() const override { return matrices_; }

 private:
  void assemble(double accuracy);
  std::size_t node_of(std::size_t representative) const { return classes_.representatives()[representative]; }
  Eigen::MatrixXd const& shells(int mirror_class) const { return matrices_[mirror_class]; }
  Eigen::MatrixXd const& loads(int mirror_class) const { return matrices_[MirrorClasses::count + mirror_class]; }
  PointArray to_polar(ConstPoints field) const;

  Surface const& surface_;
  Side side_;
  int n_shell_;
  MirrorClasses classes_;
  AzimuthTransform transform_;
  // [class] boundary data -> shells, transposed: size x (size (n_shell - 1)); then [class] -> load: 6 x size, exterior
  Matrices matrices_;
};

}  // namespace asterflow

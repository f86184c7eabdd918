#pragma once
// Solution operator (shell_operator.hpp) of a surface without symmetry as one dense matrix; equation as in
// modal_boundary.hpp, rows of general_rows.hpp. Meant for orders up to 16 (0.4 GB).

#include "surface/shell_operator.hpp"
#include "surface/surface.hpp"

namespace asterflow {

class DoubleLayer;

class GeneralDirichlet : public ShellOperator {
 public:
  // Keeps a reference to the surface.
  GeneralDirichlet(Surface const& surface, Side side, int n_shell, double accuracy);

  void shell_modes(ConstPoints boundary_velocity, std::vector<ShellMode>& modes) const override;
  Eigen::Matrix<double, 6, 1> load(ConstPoints boundary_velocity) const override;
  std::size_t memory() const override;

 private:
  // Columns: velocity at shell k >= 1 along direction of node i, in the order (k, i, component); rows: density.
  Eigen::MatrixXd shell_rows(DoubleLayer const& layer, Eigen::MatrixXd const& loads) const;

  Surface const& surface_;
  Side side_;
  int n_shell_;
  AzimuthTransform transform_;
  Eigen::MatrixXd shells_;  // (3 size) x (3 size (n_shell - 1)), transposed operator
  Eigen::MatrixXd loads_;   // 6 x (3 size) of boundary velocity, exterior
};

}  // namespace asterflow

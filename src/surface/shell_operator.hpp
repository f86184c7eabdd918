#pragma once
// The precomputed solution of a Stokes-Dirichlet problem as a linear map: boundary velocity at the nodes of a surface ->
// velocity on shells around it (shell_table.hpp). Exterior shell values are velocity / s, s = 1/rho, finite at infinity.

#include "base/arrays.hpp"
#include "surface/shell_table.hpp"

namespace asterflow {

enum class Side { interior, exterior };

class ShellOperator {
 public:
  virtual ~ShellOperator() = default;
  // Coefficients of all azimuthal modes on all shells; overwrites. In single precision: to 1e-4 of the largest.
  // Calls on one object must not overlap.
  virtual void shell_modes(ConstPoints boundary_velocity, std::vector<ShellMode<double>>& modes) const = 0;
  virtual void shell_modes(ConstPoints boundary_velocity, std::vector<ShellMode<float>>& modes) const = 0;
  // Exterior: force and torque about the centre, along (e_1, e_2, e_3), viscosity 1.
  virtual Eigen::Matrix<double, 6, 1> load(ConstPoints boundary_velocity) const = 0;
  // Everything that was computed: what an equal operator can be made of (operator_cache.hpp).
  using Matrices = std::vector<Eigen::MatrixXd>;
  virtual Matrices const& matrices() const = 0;
  virtual std::size_t memory() const {  // bytes
    std::size_t numbers = 0;
    for (auto const& matrix : matrices()) numbers += static_cast<std::size_t>(matrix.size());
    return sizeof(double) * numbers;
  }
};

}  // namespace asterflow

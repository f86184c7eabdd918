#pragma once
// The double layer of one closed surface as rows over its nodes, and the completed boundary equation on the surface
// itself (modal_boundary.hpp; kernel and signs: modal_rows.hpp). Axisymmetric surfaces go mode by mode, others node by
// node. Coordinates are the shape's own frame, densities are velocities, loads are for viscosity 1.

#include "surface/general_rows.hpp"
#include "surface/modal_boundary.hpp"

#include <Eigen/LU>
#include <array>
#include <memory>

namespace asterflow {

class DoubleLayer {
 public:
  DoubleLayer(Surface surface, Side side, double digits);

  Surface const& surface() const { return surface_; }
  Side side() const { return side_; }

  // Velocity at a target off the surface, at any distance: u = rows * q, without the completion.
  NodeRows rows(Vec3d target) const;
  // The completed equation of the surface alone: v = (+-1/2 + D) q + completion. Overwrites.
  void apply(ConstPoints q, Points v) const;
  Eigen::MatrixXd equation() const;  // of apply: (3 size) x (3 size)
  // Its inverse where the surface is axisymmetric, else the multiple of the identity that it clusters around. Overwrites.
  void precondition(ConstPoints v, Points q) const;

  // Exterior completion: force and torque about the centre on the fluid, and their velocity at a point.
  using Load = std::array<Vec3d, 2>;
  Load load(ConstPoints q) const;
  Vec3d velocity_of_load(Load const& load, Vec3d target) const;

 private:
  NodeRows expand(ModalRowSet const& modal, double phi) const;
  void apply_modes(ConstPoints q, Points v) const;

  Surface surface_;
  Side side_;
  std::unique_ptr<ModalBoundary> modes_;  // axisymmetric surfaces
  std::vector<Eigen::PartialPivLU<Eigen::MatrixXd>> inverses_;
  std::unique_ptr<GeneralRows> nodes_;    // others
  Eigen::MatrixXd matrix_;                // D on the nodes, (3 size) x (3 size)
};

}  // namespace asterflow

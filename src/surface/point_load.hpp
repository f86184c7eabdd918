#pragma once
// Completion of the exterior double layer: force and torque at the centre, taken from the density [Power & Miranda 1987],
//   F = -2/l int q dS,   T = -2/l int (y - centre) x q dS,   l^2 = area / (4 pi),
// and the velocity of both, Stokeslet and rotlet, for viscosity 1. Coordinates are the shape's own frame.

#include "surface/surface.hpp"

#include <Eigen/Core>

namespace asterflow {

class PointLoad {
 public:
  explicit PointLoad(Surface const& surface);  // keeps a reference to the surface

  Eigen::MatrixXd rows() const;                            // density of all nodes -> (F, T): 6 x (3 size)
  Eigen::Matrix<double, 3, 6> velocity(Vec3d x) const;     // of unit forces and torques
 private:
  Surface const& surface_;
};

}  // namespace asterflow

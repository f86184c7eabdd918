#pragma once
// Band-limited transfer of nodal values between two grids on the same surface, by spherical harmonics up to the
// lower of the two orders: exact for values that the coarser grid resolves.

#include "surface/sphere_grid.hpp"

#include <Eigen/Core>

namespace asterflow {

// [to.size(), from.size()]
Eigen::MatrixXd grid_transfer(SphereGrid const& from, SphereGrid const& to);

}  // namespace asterflow

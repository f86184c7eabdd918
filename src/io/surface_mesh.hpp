#pragma once
// Closed surfaces as triangles, for display.

#include "io/vtk_file.hpp"
#include "surface/shape_spec.hpp"

#include <Eigen/Geometry>

namespace asterflow {

// Appends the surface, turned and placed; n_theta rings of 2 n_theta points between the poles.
void add_surface(ShapeSpec const& shape, Vec3d position, Eigen::Quaterniond const& orientation, int n_theta,
                 PolyMesh& mesh);

}  // namespace asterflow

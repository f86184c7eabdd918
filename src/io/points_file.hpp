#pragma once
// A user's points for asterflow sum, an HDF5 file with the datasets
//   sources [n, 3], strengths [n, 3], targets [m, 3] (the sources when absent), normals [n, 3] (stresslet only)

#include "base/arrays.hpp"

#include <string>
#include <vector>

namespace asterflow {

struct PointsFile {
  PointArray sources;    // [n, 3] um
  PointArray strengths;  // [n, 3] forces, torques or densities
  PointArray normals;    // [n, 3] of any length, empty when not needed
  PointArray targets;    // [m, 3] um
};

// Throws SceneError when something is missing, of the wrong shape, or not finite.
PointsFile read_points_file(std::string const& path, bool needs_normals);

// Writes the datasets velocity [m, 3] and, unless empty, gradient [m, 3, 3] (d velocity_i / d x_j; given as 3 m
// points) and pressure [m]. A file that was there is replaced once the new one is complete.
void write_sums(std::string const& path, ConstPoints velocity, ConstPoints gradient, std::vector<double> const& pressure);

}  // namespace asterflow

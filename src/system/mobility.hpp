#pragma once
// Instantaneous resistance and mobility of the bodies of a scene as it stands: forces and torques (about the centres)
// against velocities and angular velocities, with all interactions of the scene's level. Fibers keep their shape
// (rigid_fibers.hpp): those that a body holds move with it, free ones drift without force and torque. Without fibers
// the result meets the accuracy of the run down to small gaps (surface/resistance.hpp); all surfaces then take the largest
// `order` given.

#include "io/scene.hpp"

#include <Eigen/Core>

namespace asterflow {

struct SceneMobility {
  std::vector<std::string> names;  // [n_body]
  Eigen::MatrixXd resistance;      // [6 n_body, 6 n_body]  pN s/um, pN s, pN s um
  Eigen::MatrixXd mobility;        // its inverse
  double error = 0.0;              // estimated, relative, of a scene without fibers; 0: not estimated
};

SceneMobility scene_mobility(Scene const& scene);

}  // namespace asterflow

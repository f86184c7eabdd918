#pragma once
// The precomputed flows of a scene's surfaces at one resolution; bodies of equal shape and order share theirs.

#include "io/scene.hpp"
#include "system/radiation.hpp"

namespace asterflow {

struct SceneFlows {
  std::vector<Radiation::Flow> bodies;
  Radiation::Flow periphery;  // null unless the scene is confined
};

enum class Resolution { fine, coarse };  // coarse: for the preconditioner

SceneFlows make_flows(Scene const& scene, Resolution resolution);

// How the objects of a scene exchange their flows; nothing in a `local` scene.
struct SceneRadiation {
  std::unique_ptr<Radiation> fine;
  std::unique_ptr<Radiation> coarse;  // for the preconditioner; only with fibers and a tight tolerance
};

SceneRadiation make_radiation(Scene const& scene, SceneFlows const& flows, bool has_fibers);

// Spectral order of a surface: the scene's, else from the accuracy of the run.
int surface_order(ShapeSpec const& shape, int order_in_scene, double accuracy);

// Resistance of a body alone in unbounded fluid, force and torque about its centre.
Matrix6 body_resistance(DirichletFlow const& flow, RigidPose const& pose, double viscosity);

}  // namespace asterflow

#pragma once
// The precomputed flows of a scene's surfaces at one resolution; bodies of equal shape and order share theirs.

#include "background/background_flow.hpp"
#include "io/scene.hpp"
#include "system/radiation.hpp"

namespace asterflow {

struct SceneFlows {
  std::vector<Radiation::Flow> bodies;
  Radiation::Flow periphery;  // null unless the scene is confined
  std::optional<ImageWall> near_periphery;                // none unless there are fibers with images behind it
  std::shared_ptr<ScreenedForces const> screened_forces;  // null there too, and at a triaxial periphery
};

SceneFlows make_flows(Scene const& scene);

// The periphery as images behind it see it; none unless it confines fibers that have images.
std::optional<ImageWall> wall_of_images(Scene const& scene, Surface const& periphery);

RadiationOptions radiation_options(Scene const& scene, SceneFlows const& flows);

// How the objects of a scene exchange their flows; null in a `local` scene.
std::unique_ptr<Radiation> make_radiation(Scene const& scene, SceneFlows const& flows);

// Spectral order of a surface: the scene's, else from the accuracy of the run.
int surface_order(ShapeSpec const& shape, int order_in_scene, double accuracy);

// With its grid in a run.
Surface plain_surface(ShapeSpec const& shape, int order);

// Resistance of a body alone in unbounded fluid, force and torque about its centre.
Matrix6 body_resistance(DirichletFlow const& flow, RigidPose const& pose, double viscosity);
// Force and torque about its centre on a body alone that is held in that flow.
Vector6 body_load(DirichletFlow const& flow, RigidPose const& pose, double viscosity, BackgroundFlow const& background);
// The same of a flow given at the nodes of its surface, um/s.
Vector6 body_load(DirichletFlow const& flow, RigidPose const& pose, double viscosity, ConstPoints incident);

}  // namespace asterflow

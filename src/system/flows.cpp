#include "system/flows.hpp"

namespace asterflow {
namespace {

constexpr double plane_images_suffice = 0.9e-4;  // accuracy; images that follow the curvature of a cell cost five times as much

// Builds each flow once.
class FlowLibrary {
 public:
  explicit FlowLibrary(double accuracy) : accuracy_(accuracy) {}

  Radiation::Flow get(ShapeSpec const& spec, int order_in_scene, Side side) {
    int const order = surface_order(spec, order_in_scene, accuracy_);
    for (auto const& made : flows_)
      if (made.shape == spec && made.flow->surface().order() == order && made.flow->side() == side) return made.flow;
    auto flow = std::make_shared<DirichletFlow const>(plain_surface(spec, order), side, accuracy_);
    flows_.push_back({spec, flow});
    return flow;
  }

 private:
  double accuracy_;
  struct Made {
    ShapeSpec shape;
    Radiation::Flow flow;
  };
  std::vector<Made> flows_;
};

// Of forces and torques, from the body frame to space.
Matrix6 turn_of(RigidPose const& pose) {
  Matrix6 turn = Matrix6::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = pose.rotation;
  return turn;
}

}  // namespace

Surface plain_surface(ShapeSpec const& spec, int order) {
  auto const shape = make_shape(spec);
  return Surface(shape, grid_of_order(*shape, order));
}

int surface_order(ShapeSpec const& shape, int order_in_scene, double accuracy) {
  return order_in_scene > 0 ? order_in_scene : default_order(*make_shape(shape), accuracy);
}

SceneFlows make_flows(Scene const& scene) {
  FlowLibrary library(scene.run.accuracy);
  SceneFlows flows;
  for (auto const& body : scene.bodies) flows.bodies.push_back(library.get(body.shape, body.order, Side::exterior));
  if (scene.run.interactions == Interactions::confined && scene.periphery)
    flows.periphery = library.get(scene.periphery->shape, scene.periphery->order, Side::interior);
  if (flows.periphery) flows.near_periphery = wall_of_images(scene, flows.periphery->surface());
  if (flows.near_periphery) flows.screened_forces = make_screened_forces(*flows.near_periphery, scene.run.accuracy);
  return flows;
}

std::optional<ImageWall> wall_of_images(Scene const& scene, Surface const& periphery) {
  bool const has_fibers = !scene.fibers.empty() || !scene.asters.empty();
  if (!has_fibers || scene.run.interactions != Interactions::confined || scene.run.images == ImagesBehind::nothing) return {};
  return ImageWall(periphery, Side::interior, scene.run.accuracy < plane_images_suffice);
}

RadiationOptions radiation_options(Scene const& scene, SceneFlows const& flows) {
  return {.viscosity = scene.fluid.viscosity,
          .evaluator = scene.run.evaluator,
          .accuracy = scene.run.evaluator_accuracy,
          .has_images_behind_periphery = scene.run.images != ImagesBehind::nothing,
          .has_images_in_bodies = scene.run.images == ImagesBehind::everything,
          .near_periphery = flows.near_periphery,
          .screened_forces = flows.screened_forces};
}

std::unique_ptr<Radiation> make_radiation(Scene const& scene, SceneFlows const& flows) {
  if (scene.run.interactions == Interactions::local) return nullptr;
  return std::make_unique<Radiation>(flows.bodies, flows.periphery, radiation_options(scene, flows));
}

Matrix6 body_resistance(DirichletFlow const& flow, RigidPose const& pose, double viscosity) {
  Matrix6 const turn = turn_of(pose);
  return viscosity * turn * flow.resistance() * turn.transpose();
}

Vector6 body_load(DirichletFlow const& flow, RigidPose const& pose, double viscosity, ConstPoints incident) {
  return viscosity * turn_of(pose) * load_in_body_frame(flow, pose, incident);
}

Vector6 body_load(DirichletFlow const& flow, RigidPose const& pose, double viscosity, BackgroundFlow const& background) {
  PointArray incident;
  for (Vec3d const node : flow.surface().nodes()) incident.push_back(background.velocity(pose.point(node)));
  return body_load(flow, pose, viscosity, incident);
}

}  // namespace asterflow

#include "system/flows.hpp"

#include "system/scattering.hpp"

#include <algorithm>

namespace asterflow {
namespace {

constexpr int lowest_order = 6;

// Builds each flow once.
class FlowLibrary {
 public:
  FlowLibrary(double accuracy, Resolution resolution) : accuracy_(accuracy), resolution_(resolution) {}

  Radiation::Flow get(ShapeSpec const& spec, int order_in_scene, Side side) {
    int order = surface_order(spec, order_in_scene, accuracy_);
    // Fibers start on bodies, so bodies keep their order in the preconditioner; the periphery is farther away.
    if (resolution_ == Resolution::coarse && side == Side::interior) order = std::min(order, std::max(lowest_order, order / 2));
    for (auto const& made : flows_)
      if (made.shape == spec && made.flow->surface().order() == order && made.flow->side() == side) return made.flow;
    double const accuracy = resolution_ == Resolution::fine ? accuracy_ : 1e-3;
    auto flow = std::make_shared<DirichletFlow const>(Surface(make_shape(spec), order), side, accuracy);
    flows_.push_back({spec, flow});
    return flow;
  }

 private:
  double accuracy_;
  Resolution resolution_;
  struct Made {
    ShapeSpec shape;
    Radiation::Flow flow;
  };
  std::vector<Made> flows_;
};

}  // namespace

int surface_order(ShapeSpec const& shape, int order_in_scene, double accuracy) {
  return order_in_scene > 0 ? order_in_scene : default_order(*make_shape(shape), accuracy);
}

SceneFlows make_flows(Scene const& scene, Resolution resolution) {
  FlowLibrary library(scene.run.accuracy, resolution);
  SceneFlows flows;
  for (auto const& body : scene.bodies) flows.bodies.push_back(library.get(body.shape, body.order, Side::exterior));
  if (scene.run.interactions == Interactions::confined && scene.periphery)
    flows.periphery = library.get(scene.periphery->shape, scene.periphery->order, Side::interior);
  return flows;
}

SceneRadiation make_radiation(Scene const& scene, SceneFlows const& flows, bool has_fibers) {
  SceneRadiation radiation;
  auto const& run = scene.run;
  if (run.interactions == Interactions::local) return radiation;
  auto const make = [&](SceneFlows const& level, double accuracy) {
    return std::make_unique<Radiation>(level.bodies, level.periphery,
                                       RadiationOptions{scene.fluid.viscosity, run.evaluator, accuracy});
  };
  radiation.fine = make(flows, run.evaluator_accuracy);
  if (has_fibers && run.gmres_tolerance < loose_tolerance)
    radiation.coarse = make(make_flows(scene, Resolution::coarse), 1e-3);
  return radiation;
}

Matrix6 body_resistance(DirichletFlow const& flow, RigidPose const& pose, double viscosity) {
  Matrix6 turn = Matrix6::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = pose.rotation;
  return viscosity * turn * flow.resistance() * turn.transpose();
}

}  // namespace asterflow

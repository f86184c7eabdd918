#include "system/stored_flow.hpp"

#include "background/background_flow.hpp"
#include "base/error.hpp"
#include "io/frame.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace asterflow {

StoredFlow::StoredFlow(Scene const& scene, Frame const& frame)
    : StoredFlow(scene, make_flows(scene), frame) {}

StoredFlow::StoredFlow(Scene const& scene, SceneFlows const& flows, Frame const& frame) : scene_(scene) {
  if (scene.run.interactions == Interactions::local)
    throw SceneError(scene.file + ": interactions = \"local\" models no flow; run the scene with open or confined");
  if (frame.time == 0.0)
    throw SceneError(fmt::format("{}: the state at t = 0 was stored before the first solve; choose a later --time",
                                 scene.file));
  radiation_ = std::make_unique<Radiation>(flows.bodies, flows.periphery, radiation_options(scene, flows));

  auto const poses = flow_poses(frame);
  auto const velocities = points_of(frame, "body/velocity"), turning = points_of(frame, "body/angular_velocity");
  for (std::size_t b = 0; b < poses.size(); ++b) {
    motions_.emplace_back();
    motions_.back() << to_eigen(velocities.at(b)), to_eigen(turning.at(b));
  }
  auto const nodes = flow_nodes(frame);
  auto const weights = numbers_of(frame, "fiber/weight");
  auto const stored_first = integers_of(frame, "fiber/first");
  std::vector<std::size_t> first(stored_first.begin(), stored_first.end());
  if (first.empty()) first.push_back(0);
  radiation_->set_geometry({nodes, weights, &first}, poses);

  force_density_ = points_of(frame, "fiber/force_density");
  incident_.assign(nodes.size(), Vec3d{});  // that of the fibers is not needed
  auto const at_surfaces = points_of(frame, "flow/incident");
  incident_.insert(incident_.end(), at_surfaces.begin(), at_surfaces.end());
  if (incident_.size() != radiation_->nodes().size() || force_density_.size() != nodes.size())
    throw SceneError(fmt::format("the state at t = {:g} s does not belong to this scene", frame.time));
}

void StoredFlow::velocity(ConstPoints points, Points velocity) const {
  std::fill(velocity.begin(), velocity.end(), Vec3d{});
  radiation_->add_velocity(force_density_, motions_, incident_, points, velocity);
  if (scene_.background) BackgroundFlow(*scene_.background).add_velocity(points, velocity);
}

PointArray StoredFlow::incident_at_fibers() const {
  PointArray received(incident_.size());
  if (scene_.background) BackgroundFlow(*scene_.background).add_velocity(radiation_->nodes(), received);
  radiation_->exchange(force_density_, motions_, std::vector<bool>(motions_.size(), false), incident_, received);
  received.resize(force_density_.size());
  return received;
}

}  // namespace asterflow

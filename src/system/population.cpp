#include "system/population.hpp"

#include "base/parallel.hpp"
#include "fiber/fitted_centreline.hpp"

#include <algorithm>

namespace asterflow {
namespace {

// A growing tip turns back at this distance from the cortex, um, so that the fluid between them stays resolved.
constexpr double cortex_margin = 0.1;
// Growing fibers are resolved up to this length, um, whatever their length at the start.
constexpr double resolved_length = 10.0;

RigidPose pose_of(Scene const& scene, int body) {
  if (body < 0) return {};
  return {scene.bodies[body].position, scene.bodies[body].orientation.toRotationMatrix()};
}

FiberProperties properties_of(Scene const& scene, FiberMaterialSpec const& material, double length) {
  double const to_resolve = material.growing ? std::max(length, resolved_length) : length;
  FiberProperties properties;
  properties.bending_rigidity = material.bending_rigidity;
  properties.radius = material.radius;
  properties.n_node = material.nodes > 0 ? material.nodes : default_node_count(to_resolve, scene.run.accuracy);
  return properties;
}

void add_single(Scene const& scene, FiberSpec const& spec, Fibers& fibers, std::optional<DynamicInstability>& growth) {
  auto properties = properties_of(scene, spec.material, spec.length);
  properties.load.external = spec.force_density;
  properties.tip.force = spec.end_force;
  Centreline const shape = spec.points.empty()
                               ? straight_centreline(spec.position, spec.direction, spec.length, properties.n_node)
                               : centreline_through(spec.points, properties.n_node);
  int const body = body_index(scene, spec.body);
  RigidPose const pose = pose_of(scene, body);
  Matrix3 const back = pose.rotation.transpose();
  MinusEndSite const site{spec.material.minus_end, body, back * (shape.minus_end - pose.position),
                          back * shape.tangents.front()};
  std::size_t const index = fibers.add(properties, site, shape);
  if (spec.material.growing && growth) growth->add(index, shape.length);
}

}  // namespace

void add_scene_fibers(Scene const& scene, Fibers& fibers, std::optional<DynamicInstability>& growth) {
  for (auto const& spec : scene.fibers) add_single(scene, spec, fibers, growth);
  if (scene.asters.empty()) return;
  PlacedScene const placed(scene.bodies, scene.periphery ? &scene.periphery->shape : nullptr);
  for (std::size_t number = 0; number < scene.asters.size(); ++number) {
    auto const& aster = scene.asters[number];
    int const body = body_index(scene, aster.body);
    RigidPose const pose = pose_of(scene, body);
    auto const properties = properties_of(scene, aster.material, aster.length);
    auto const reach = [&](MinusEndSite const& site) {
      return placed.reach(pose.point(site.position), pose.rotation * site.direction, 1e3) -
             cortex_margin;
    };
    for (auto const& fiber : aster_fibers(aster, aster.count, body, scene.run.seed, number, reach)) {
      auto const shape = straight_centreline(pose.point(fiber.site.position),
                                             pose.rotation * fiber.site.direction, fiber.length, properties.n_node);
      std::size_t const index = fibers.add(properties, fiber.site, shape);
      if (aster.material.growing && growth) growth->add(index, fiber.length);
    }
  }
}

GrowthSurroundings::GrowthSurroundings(Scene const& scene) {
  if (scene.periphery) cortex_ = make_shape(scene.periphery->shape);
}

std::vector<TipSurroundings> GrowthSurroundings::at_tips(Fibers const& fibers, DynamicInstability const& growth,
                                                         std::span<RigidPose const> poses,
                                                         std::span<Vector6 const> motions) const {
  if (!cortex_) return {};
  std::vector<TipSurroundings> surroundings(growth.tips().size());
  parallel_for("GrowthSurroundings::at_tips", static_cast<long>(surroundings.size()), [&](long i) {
    std::size_t const fiber = growth.tips()[i].fiber;
    Centreline const& shape = fibers.shape(fiber);
    Vec3d const tip = plus_end(shape);
    ClosestPoint const wall = cortex_->closest_point(tip);
    // The cortex as its tangent plane at the closest point, met along the tangent of the fiber.
    double const slope = dot(shape.tangents.back(), wall.normal);
    if (slope <= 0.05) return;
    surroundings[i].clearance = std::max(0.0, -wall.distance - cortex_margin) / slope;
    if (int const body = fibers.site(fiber).body; fibers.site(fiber).is_attached()) {
      Vec3d const velocity = velocity_of_motion(motions[body], tip - poses[body].position);
      surroundings[i].approach_speed = dot(velocity, wall.normal) / slope;
    }
  });
  return surroundings;
}

}  // namespace asterflow

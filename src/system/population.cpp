#include "system/population.hpp"

#include "fiber/fitted_centreline.hpp"
#include "io/scene_geometry.hpp"

#include <algorithm>
#include <cmath>

namespace asterflow {
namespace {

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
  properties.is_nonlocal = material.nonlocal;
  properties.n_node = material.nodes > 0 ? material.nodes : default_node_count(to_resolve, scene.run.accuracy);
  return properties;
}

// Of the contact of a plus end with the cortex, pN/um: the scene's, else 100 E / a^2 with the radius a of the body.
double spring_stiffness(Scene const& scene, double bending_rigidity, int body) {
  if (!scene.pushing) return 0.0;
  if (scene.pushing->spring_stiffness || body < 0) return scene.pushing->spring_stiffness.value_or(0.0);
  return 100.0 * bending_rigidity / std::pow(outer_radius(scene.bodies[body].shape), 2);
}

void add_single(Scene const& scene, FiberSpec const& spec, Fibers& fibers, std::optional<PlusEnds>& growth) {
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
  if (spec.material.growing && growth) growth->add(index, shape.length, spring_stiffness(scene, properties.bending_rigidity, body));
}

}  // namespace

void add_scene_fibers(Scene const& scene, Fibers& fibers, std::optional<PlusEnds>& growth) {
  for (auto const& spec : scene.fibers) add_single(scene, spec, fibers, growth);
  if (scene.asters.empty()) return;
  PlacedScene const placed(scene.bodies, scene.periphery ? &scene.periphery->shape : nullptr);
  for (std::size_t number = 0; number < scene.asters.size(); ++number) {
    auto const& aster = scene.asters[number];
    int const body = body_index(scene, aster.body);
    RigidPose const pose = pose_of(scene, body);
    auto const properties = properties_of(scene, aster.material, aster.length);
    double const margin = scene.dynamic_instability ? scene.dynamic_instability->cortex_margin
                                                    : std::min(DynamicInstabilitySpec{}.cortex_margin, 0.05 * aster.length);
    auto const reach = [&](MinusEndSite const& site) {
      return placed.reach(pose.point(site.position), pose.rotation * site.direction, 100.0 * aster.length) - margin;
    };
    double const decay = scene.dynamic_instability ? length_decay(*scene.dynamic_instability) : 0.0;
    bool const grows = aster.material.growing && growth;
    for (auto const& fiber : aster_fibers(aster, aster.count, body, scene.run.seed, number, reach, decay)) {
      Vec3d const start = pose.point(fiber.site.position), direction = pose.rotation * fiber.site.direction;
      double const length = grows ? growth->length_at_rest(fiber.length, start + fiber.length * direction, direction) : fiber.length;
      std::size_t const index = fibers.add(properties, fiber.site, straight_centreline(start, direction, length, properties.n_node));
      if (grows) growth->add(index, length, spring_stiffness(scene, properties.bending_rigidity, body));
    }
  }
}

}  // namespace asterflow

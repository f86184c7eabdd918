#include "system/placement.hpp"

#include "surface/contact.hpp"

#include <fmt/format.h>

namespace asterflow {
namespace {

// Of the distance from the centre: what is closer to a surface counts as on it, as for its flow (dirichlet_flow.cpp).
constexpr double touching = 1e-3;

PlacedSurface placed(std::shared_ptr<Shape const> shape, RigidPose const& pose) {
  return {std::move(shape), pose.position, Eigen::Quaterniond(pose.rotation)};
}

std::string place_words(Vec3d x) { return fmt::format("at [{:.4g}, {:.4g}, {:.4g}] um", x.x, x.y, x.z); }

// What may hold two objects apart, after a complaint; `holds`: the key of the repulsion between them.
std::string remedy(Scene const& scene, bool StericRepulsionSpec::* holds, char const* key, char const* force) {
  auto const& repulsion = scene.steric_repulsion;
  if (!repulsion) return fmt::format(" ([steric_repulsion] with {} = true may hold it back)", key);
  if (!((*repulsion).*holds)) return fmt::format(" (steric_repulsion.{} = true may hold it back)", key);
  return fmt::format(" (a larger steric_repulsion.{} may hold it back)", force);
}

// A fiber in contact with a body is pushed the wrong way by a flow that does not resolve its reflection there.
std::string remedy_of_bodies(Scene const& scene) {
  bool const is_held = scene.steric_repulsion && scene.steric_repulsion->fiber_body;
  if (is_held && scene.run.images != ImagesBehind::everything && scene.run.interactions != Interactions::local)
    return " (run.images = \"all\", which resolves the flow between them, or a larger steric_repulsion.fiber_force may hold it back)";
  return remedy(scene, &StericRepulsionSpec::fiber_body, "fiber_body", "fiber_force");
}

}  // namespace

std::string fiber_words(Scene const& scene, std::size_t fiber) {
  auto const on = [](std::string const& body) { return body.empty() ? "" : fmt::format(" on body \"{}\"", body); };
  if (fiber < scene.fibers.size()) return fmt::format("[[fiber]] #{}{}", fiber + 1, on(scene.fibers[fiber].body));
  std::size_t number = fiber - scene.fibers.size();
  for (std::size_t i = 0; i < scene.asters.size(); ++i) {
    auto const count = static_cast<std::size_t>(scene.asters[i].count);
    if (number < count) return fmt::format("fiber {} of [[aster]] #{}{}", number + 1, i + 1, on(scene.asters[i].body));
    number -= count;
  }
  return fmt::format("fiber {}", fiber + 1);
}

Placement::Placement(Scene const& scene)
    : scene_(scene), checks_fibers_(scene.run.interactions != Interactions::local),
      checks_fibers_inside_(scene.run.interactions == Interactions::confined) {
  for (auto const& body : scene.bodies) bodies_.push_back(make_shape(body.shape));
  if (scene.periphery) periphery_ = make_shape(scene.periphery->shape);
}

std::string Placement::complaint(std::span<RigidPose const> poses) const {
  for (std::size_t b = 0; b < poses.size(); ++b) {
    auto const words = [&](std::string const& what) {
      return fmt::format("body \"{}\" {} {}", scene_.bodies[b].name, what, place_words(poses[b].position));
    };
    PlacedSurface const body = placed(bodies_[b], poses[b]);
    if (periphery_ && !(find_contact(body, {.shape = periphery_, .encloses = true}).gap > 0))
      return words("touches the periphery,") + remedy(scene_, &StericRepulsionSpec::body_cortex, "body_cortex", "body_force");
    for (std::size_t a = 0; a < b; ++a) {
      if (norm(poses[a].position - poses[b].position) > bodies_[a]->size() + bodies_[b]->size()) continue;
      if (!(find_contact(placed(bodies_[a], poses[a]), body).gap > 0))
        return words(fmt::format("overlaps body \"{}\",", scene_.bodies[a].name)) +
               remedy(scene_, &StericRepulsionSpec::body_body, "body_body", "body_force");
    }
  }
  return {};
}

std::string Placement::complaint(std::size_t fiber, ConstPoints positions, std::span<RigidPose const> poses) const {
  for (Vec3d x : positions) {
    if (checks_fibers_inside_ && !(periphery_->shell_point(x).rho <= 1 + touching))
      return fmt::format("{} reaches outside the periphery {}{}", fiber_words(scene_, fiber), place_words(x),
                         remedy(scene_, &StericRepulsionSpec::fiber_cortex, "fiber_cortex", "fiber_force"));
    for (std::size_t b = 0; b < poses.size(); ++b) {
      Vec3d const in_body = poses[b].rotation.transpose() * (x - poses[b].position);
      if (!(bodies_[b]->shell_point(in_body).rho >= 1 - touching))
        return fmt::format("{} reaches into body \"{}\" {}{}", fiber_words(scene_, fiber), scene_.bodies[b].name,
                           place_words(x), remedy_of_bodies(scene_));
    }
  }
  return {};
}

}  // namespace asterflow

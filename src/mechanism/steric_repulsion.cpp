#include "mechanism/steric_repulsion.hpp"

#include "base/parallel.hpp"
#include "mechanism/fiber_contacts.hpp"
#include "surface/contact.hpp"

namespace asterflow {

StericRepulsion::StericRepulsion(StericRepulsionSpec const& spec, std::shared_ptr<Shape const> cortex,
                                 std::vector<std::shared_ptr<Shape const>> bodies)
    : spec_(spec), cortex_(std::move(cortex)), bodies_(std::move(bodies)), fiber_loads_(bodies_.size(), Vector6::Zero()) {}

void StericRepulsion::hold(Fibers& fibers, ConstPoints u, std::span<BodyMotionMap const> bodies) {
  if (!(cortex_ && spec_.fiber_cortex) && !spec_.fiber_body) return;
  FiberSurroundings const around{spec_, cortex_.get(), bodies_, bodies};
  std::vector<std::vector<BodyReaction>> reactions(fibers.count());
  parallel_for("StericRepulsion::hold", static_cast<long>(fibers.count()), [&](long i) {
    reactions[i] = FiberContacts(around, fibers, static_cast<std::size_t>(i)).hold(u);
  });
  fiber_loads_.assign(bodies_.size(), Vector6::Zero());
  for (auto const& of_fiber : reactions)
    for (BodyReaction const& reaction : of_fiber) fiber_loads_[reaction.body] += reaction.load;
}

ContactLoad StericRepulsion::on_body(std::size_t body, BodyMotionMap const& map) const {
  ContactLoad result{.load = fiber_loads_[body]};
  if (!cortex_ || !spec_.body_cortex) return result;
  PlacedSurface const placed{bodies_[body], map.predicted.position, Eigen::Quaterniond(map.predicted.rotation)};
  Contact const contact = find_contact(placed, {.shape = cortex_, .encloses = true});
  if (!(contact.gap < spec_.range)) return result;
  Vec3d const arm = contact.first - map.predicted.position;
  Eigen::Vector3d const away = -to_eigen(cortex_->closest_point(contact.first).normal);
  Eigen::Matrix<double, 3, 6> motion, lever;  // of the point by q, um s; and its velocity
  motion << map.displacement_per_velocity * Matrix3::Identity(), -cross_matrix(arm) * map.turn_per_angular_velocity;
  lever << Matrix3::Identity(), -cross_matrix(arm);
  Matrix3 const stiffness = spec_.body_force / spec_.range * away * away.transpose();
  result.resistance = lever.transpose() * stiffness * motion;
  result.load += lever.transpose() * (spec_.body_force * (1 - contact.gap / spec_.range) * away) +
                result.resistance * map.predicted_motion();
  return result;
}

}  // namespace asterflow

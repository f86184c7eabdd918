#include "mechanism/fiber_contacts.hpp"

#include "fiber/fiber_basis.hpp"

#include <algorithm>

namespace asterflow {
namespace {

constexpr int most_passes = 8;
constexpr double plus_end_length = 1.0;  // um of fiber as which a plus end is repelled

}  // namespace

FiberContacts::FiberContacts(FiberSurroundings const& around, Fibers& fibers, std::size_t fiber)
    : around_(around), fibers_(fibers), fiber_(fiber), first_(fibers.first_node(fiber)) {
  MinusEndSite const& site = fibers.plan(fiber).site;
  holder_ = site.is_attached() ? site.body : -1;
  motion_ = holder_ >= 0 ? around.motions[holder_].predicted_motion() : Vector6(Vector6::Zero());
  auto const nodes = fibers.nodes().subspan(first_, fibers.first_node(fiber + 1) - first_);
  predicted_.assign(nodes.begin(), nodes.end());
  positions_.resize(nodes.size());
}

// The wall of a body (-1: of the cortex) at a place closer to it than the range; false: it is not.
bool FiberContacts::find_wall(int body, Vec3d position, Wall& wall) const {
  if (body < 0) {
    ClosestPoint const closest = around_.cortex->closest_point(position);
    wall = {body, -closest.distance, -closest.normal};
  } else {
    Shape const& shape = *around_.bodies[body];
    RigidPose const& pose = around_.motions[body].predicted;
    Vec3d const in_body = pose.rotation.transpose() * (position - pose.position);
    if (norm(in_body - shape.centre()) > shape.size() + around_.spec.range) return false;
    ClosestPoint const closest = shape.closest_point(in_body);
    wall = {body, closest.distance, pose.rotation * closest.normal};
  }
  return wall.distance < around_.spec.range;
}

// function(wall) for all that repel the fiber at a place: its own body alone where it does.
template <class Function>
void FiberContacts::for_walls(Vec3d position, double arc_length, Function&& function) const {
  StericRepulsionSpec const& spec = around_.spec;
  Wall wall;
  if (spec.fiber_body && holder_ >= 0 && arc_length >= spec.exempt_length && find_wall(holder_, position, wall))
    return function(wall);
  if (spec.fiber_cortex && around_.cortex && find_wall(-1, position, wall)) function(wall);
  if (!spec.fiber_body) return;
  for (int b = 0; b < static_cast<int>(around_.bodies.size()); ++b)
    if (b != holder_ && find_wall(b, position, wall)) function(wall);
}

// strength (1 - d / d*), linear about the place where the wall was found.
FiberContacts::Push FiberContacts::push(double strength, Wall const& wall) const {
  double const range = around_.spec.range;
  return {strength * (1 - wall.distance / range) * wall.away,
          strength / range * to_eigen(wall.away) * to_eigen(wall.away).transpose()};
}

void FiberContacts::hold_plus_end(ConstPoints u) {
  TipLoad& load = fibers_.plan(fiber_).tip;
  if (!load.stiffness.isZero(0.0)) return;
  Vec3d const position = fibers_.tip_answer(fiber_, u, motion_).position;
  bool any = false;
  for_walls(position, fibers_.plan(fiber_).length, [&](Wall const& wall) {
    if (wall.body >= 0 && wall.body == holder_) return;
    Push const push = this->push(plus_end_length * around_.spec.fiber_force, wall);
    load.force += push.force;
    load.stiffness += push.stiffness;
    load.anchor = position;
    if (wall.body >= 0) plus_end_touches_.push_back({push, static_cast<std::size_t>(wall.body), 0});
    any = true;
  });
  if (any) fibers_.prepare_again(fiber_, around_.motions);
}

// Loads at those positions; false: none.
bool FiberContacts::find_nodes(ConstPoints positions) {
  auto const& basis = fiber_basis(fibers_.properties(fiber_).n_node);
  double const length = fibers_.predicted_shape(fiber_).length;
  loads_.assign(positions.size(), {});
  node_touches_.clear();
  bool any = false;
  for (std::size_t i = 0; i < positions.size(); ++i)
    for_walls(positions[i], basis.gauss.nodes[i] * length, [&](Wall const& wall) {
      Push push = this->push(around_.spec.fiber_force, wall);
      push.force += push.stiffness * (positions[i] - predicted_[i]);
      loads_[i].force += push.force;
      loads_[i].stiffness += push.stiffness;
      loads_[i].is_internal = wall.body >= 0 && wall.body == holder_;
      if (wall.body >= 0 && wall.body != holder_)
        node_touches_.push_back({push, static_cast<std::size_t>(wall.body), i});
      any = true;
    });
  return any;
}

void FiberContacts::hold_nodes(ConstPoints u) {
  PointArray before(positions_.size());
  fibers_.node_answer(fiber_, u, motion_, positions_);
  for (int pass = 0; pass < most_passes; ++pass) {
    bool const any = find_nodes(positions_);
    if (!any && fibers_.plan(fiber_).node_loads.empty()) return;
    fibers_.plan(fiber_).node_loads = loads_;
    fibers_.prepare_again(fiber_, around_.motions);
    before = positions_;
    fibers_.node_answer(fiber_, u, motion_, positions_);
    double change = 0.0;
    for (std::size_t i = 0; i < positions_.size(); ++i) change = std::max(change, norm(positions_[i] - before[i]));
    if (change < 1e-3 * around_.spec.range) return;
  }
}

// Keeps the forces of bodies that do not hold the fiber as the local answer has them.
std::vector<BodyReaction> FiberContacts::settle(ConstPoints u) {
  std::vector<BodyReaction> reactions;
  if (plus_end_touches_.empty() && node_touches_.empty()) return reactions;
  auto const react = [&](std::size_t body, Vec3d place, Vec3d force) {
    Vec3d const arm = place - around_.motions[body].predicted.position;
    reactions.push_back({body, (Vector6() << to_eigen(-force), to_eigen(cross(arm, -force))).finished()});
  };
  Fibers::Plan& plan = fibers_.plan(fiber_);
  Vec3d const plus_end_moved = fibers_.tip_answer(fiber_, u, motion_).position - plan.tip.anchor;
  for (Touch const& touch : plus_end_touches_) {
    Vec3d const loss = touch.stiffness * plus_end_moved;
    plan.tip.force -= loss;
    plan.tip.stiffness -= touch.stiffness;
    react(touch.body, plus_end(fibers_.predicted_shape(fiber_)), touch.force - loss);
  }
  for (Touch const& touch : node_touches_) {
    Vec3d const loss = touch.stiffness * (positions_[touch.node] - predicted_[touch.node]);
    plan.node_loads[touch.node].force -= loss;
    plan.node_loads[touch.node].stiffness -= touch.stiffness;
    react(touch.body, predicted_[touch.node], fibers_.weights()[first_ + touch.node] * (touch.force - loss));
  }
  fibers_.prepare_again(fiber_, around_.motions);
  return reactions;
}

std::vector<BodyReaction> FiberContacts::hold(ConstPoints u) {
  hold_plus_end(u);
  hold_nodes(u);
  return settle(u);
}

}  // namespace asterflow

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
  motion_ = holder_ >= 0 ? around.motions[holder_] : Vector6(Vector6::Zero());
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
    BodyMotionMap const& map = around_.maps[body];
    // What displaces the body displaces places beside it the other way; a fiber moves along with its own body.
    Vec3d const moved = body == holder_ ? Vec3d{} : map.displacement(around_.motions[body], position);
    Vec3d const in_body = map.predicted.rotation.transpose() * (position - moved - map.predicted.position);
    if (norm(in_body - shape.centre()) > shape.size() + around_.spec.range) return false;
    ClosestPoint const closest = shape.closest_point(in_body);
    wall = {body, closest.distance, map.predicted.rotation * closest.normal};
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

void FiberContacts::let_go(TipLoad const& free_tip) {
  Fibers::Plan& plan = fibers_.plan(fiber_);
  if (plan.node_loads.empty() && norm(plan.tip.force - free_tip.force) == 0 && plan.tip.stiffness == free_tip.stiffness) return;
  plan.node_loads.clear();
  plan.tip = free_tip;
  fibers_.prepare_again(fiber_, around_.maps);
}

void FiberContacts::answer(ConstPoints u) {
  fibers_.node_answer(fiber_, u, motion_, positions_);
  plus_end_ = fibers_.tip_answer(fiber_, u, motion_).position;
}

// The loads where the fiber is; false: no contacts.
bool FiberContacts::find_loads(TipLoad const& free_tip) {
  Fibers::Plan& plan = fibers_.plan(fiber_);
  auto const& basis = fiber_basis(fibers_.properties(fiber_).n_node);
  double const length = fibers_.predicted_shape(fiber_).length;
  plan.node_loads.assign(positions_.size(), {});
  plan.tip = free_tip;
  node_touches_.clear();
  plus_end_touches_.clear();
  bool any = false;
  for (std::size_t i = 0; i < positions_.size(); ++i)
    for_walls(positions_[i], basis.gauss.nodes[i] * length, [&](Wall const& wall) {
      Push push = this->push(around_.spec.fiber_force, wall);
      push.force += push.stiffness * (positions_[i] - predicted_[i]);
      NodeLoad& load = plan.node_loads[i];
      load.force += push.force;
      load.stiffness += push.stiffness;
      load.is_internal = is_own(wall);
      if (wall.body >= 0 && !is_own(wall)) node_touches_.push_back({push, static_cast<std::size_t>(wall.body), i});
      any = true;
    });
  if (!free_tip.stiffness.isZero(0.0)) return any;
  for_walls(plus_end_, plan.length, [&](Wall const& wall) {
    if (is_own(wall)) return;
    Push const push = this->push(plus_end_length * around_.spec.fiber_force, wall);
    plan.tip.force += push.force;
    plan.tip.stiffness += push.stiffness;
    plan.tip.anchor = plus_end_;
    if (wall.body >= 0) plus_end_touches_.push_back({push, static_cast<std::size_t>(wall.body), 0});
    any = true;
  });
  return any;
}

// Keeps the forces of bodies that do not hold the fiber as the local answer has them.
std::vector<BodyReaction> FiberContacts::settle() {
  std::vector<BodyReaction> reactions;
  if (plus_end_touches_.empty() && node_touches_.empty()) return reactions;
  auto const react = [&](Touch const& touch, Vec3d place, Vec3d force, double length) {
    auto const arm = [&](std::size_t body) { return place - around_.maps[body].predicted.position; };
    Vector6 const load = load_of_force(-length * force, arm(touch.body));
    Matrix3 const stiffness = length * touch.stiffness;
    reactions.push_back({touch.body, load, around_.maps[touch.body].spring_resistance(arm(touch.body), stiffness)});
    if (holder_ < 0) return;
    std::size_t const holder = static_cast<std::size_t>(holder_);
    reactions.push_back({holder, Vector6::Zero(), around_.maps[holder].spring_resistance(arm(holder), stiffness)});
  };
  Fibers::Plan& plan = fibers_.plan(fiber_);
  Vec3d const plus_end_moved = plus_end_ - plan.tip.anchor;
  for (Touch const& touch : plus_end_touches_) {
    Vec3d const loss = touch.stiffness * plus_end_moved;
    plan.tip.force -= loss;
    plan.tip.stiffness -= touch.stiffness;
    react(touch, plus_end(fibers_.predicted_shape(fiber_)), touch.force - loss, 1.0);
  }
  for (Touch const& touch : node_touches_) {
    Vec3d const loss = touch.stiffness * (positions_[touch.node] - predicted_[touch.node]);
    plan.node_loads[touch.node].force -= loss;
    plan.node_loads[touch.node].stiffness -= touch.stiffness;
    react(touch, predicted_[touch.node], touch.force - loss, fibers_.weights()[first_ + touch.node]);
  }
  fibers_.prepare_again(fiber_, around_.maps);
  return reactions;
}

std::vector<BodyReaction> FiberContacts::hold(ConstPoints u, TipLoad const& free_tip) {
  let_go(free_tip);
  answer(u);
  PointArray before;
  for (int pass = 0; pass < most_passes; ++pass) {
    bool const had_loads = !fibers_.plan(fiber_).node_loads.empty();
    if (!find_loads(free_tip) && !had_loads) {
      fibers_.plan(fiber_).node_loads.clear();
      return {};
    }
    fibers_.prepare_again(fiber_, around_.maps);
    before = positions_;
    double change = 0.0;
    Vec3d const plus_end_before = plus_end_;
    answer(u);
    for (std::size_t i = 0; i < positions_.size(); ++i) change = std::max(change, norm(positions_[i] - before[i]));
    if (std::max(change, norm(plus_end_ - plus_end_before)) < 1e-3 * around_.spec.range) break;
  }
  return settle();
}

}  // namespace asterflow

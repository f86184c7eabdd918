#include "mechanism/steric_repulsion.hpp"

#include "base/parallel.hpp"
#include "fiber/fiber_basis.hpp"
#include "fiber/fibers.hpp"
#include "surface/contact.hpp"

#include <algorithm>

namespace asterflow {
namespace {

constexpr int most_passes = 8;

// A plus end that nothing else holds is repelled like this length of fiber, um; false: it is not near.
constexpr double plus_end_length = 1.0;

bool hold_plus_end(TipLoad& load, TipAnswer const& tip, Shape const& cortex, StericRepulsionSpec const& spec) {
  if (!load.stiffness.isZero(0.0)) return false;
  ClosestPoint const wall = cortex.closest_point(tip.position);
  if (!(-wall.distance < spec.range)) return false;
  double const force = plus_end_length * spec.fiber_force;
  load.force -= force * (1 + wall.distance / spec.range) * wall.normal;
  load.stiffness = force / spec.range * to_eigen(wall.normal) * to_eigen(wall.normal).transpose();
  load.anchor = tip.position;
  return true;
}

}  // namespace

StericRepulsion::StericRepulsion(StericRepulsionSpec const& spec, std::shared_ptr<Shape const> cortex,
                                 std::vector<std::shared_ptr<Shape const>> bodies)
    : spec_(spec), cortex_(std::move(cortex)), bodies_(std::move(bodies)) {}

bool StericRepulsion::node_loads(Fibers const& fibers, std::size_t fiber, ConstPoints predicted, ConstPoints positions,
                                 std::span<BodyMotionMap const> bodies, std::vector<NodeLoad>& loads) const {
  loads.assign(positions.size(), {});
  bool any = false;
  // The force f_0 (1 - d / d*) along `away`, where d grows.
  auto const repel = [&](std::size_t i, double distance, Vec3d away, bool is_internal) {
    if (!(distance < spec_.range)) return;
    Matrix3 const stiffness = spec_.fiber_force / spec_.range * to_eigen(away) * to_eigen(away).transpose();
    loads[i].force += spec_.fiber_force * (1 - distance / spec_.range) * away + stiffness * (positions[i] - predicted[i]);
    loads[i].stiffness += stiffness;
    loads[i].is_internal = is_internal;
    any = true;
  };
  auto const& basis = fiber_basis(fibers.properties(fiber).n_node);
  double const length = fibers.predicted_shape(fiber).length;
  MinusEndSite const& site = fibers.site(fiber);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (cortex_ && spec_.fiber_cortex) {
      ClosestPoint const wall = cortex_->closest_point(positions[i]);
      repel(i, -wall.distance, -wall.normal, false);
    }
    if (!spec_.fiber_body || !site.is_attached() || basis.gauss.nodes[i] * length < spec_.exempt_length) continue;
    RigidPose const& pose = bodies[site.body].predicted;
    ClosestPoint const wall =
        bodies_[site.body]->closest_point(pose.rotation.transpose() * (positions[i] - pose.position));
    repel(i, wall.distance, pose.rotation * wall.normal, true);
  }
  return any;
}

void StericRepulsion::hold(Fibers& fibers, std::size_t fiber, ConstPoints u,
                           std::span<BodyMotionMap const> bodies) const {
  std::size_t const first = fibers.first_node(fiber), n = fibers.first_node(fiber + 1) - first;
  MinusEndSite const& site = fibers.plan(fiber).site;
  Vector6 const q = site.is_attached() ? bodies[site.body].predicted_motion() : Vector6::Zero();
  if (cortex_ && spec_.fiber_cortex && hold_plus_end(fibers.plan(fiber).tip, fibers.tip_answer(fiber, u, q), *cortex_, spec_))
    fibers.prepare_again(fiber, bodies);
  PointArray const predicted(fibers.nodes().begin() + long(first), fibers.nodes().begin() + long(first + n));
  PointArray positions(n), before(n);
  fibers.node_answer(fiber, u, q, positions);
  std::vector<NodeLoad> loads;
  for (int pass = 0; pass < most_passes; ++pass) {
    bool const any = node_loads(fibers, fiber, predicted, positions, bodies, loads);
    if (!any && fibers.plan(fiber).node_loads.empty()) return;
    fibers.plan(fiber).node_loads = loads;
    fibers.prepare_again(fiber, bodies);
    before = positions;
    fibers.node_answer(fiber, u, q, positions);
    double change = 0.0;
    for (std::size_t i = 0; i < n; ++i) change = std::max(change, norm(positions[i] - before[i]));
    if (change < 1e-3 * spec_.range) return;
  }
}

void StericRepulsion::hold(Fibers& fibers, ConstPoints u, std::span<BodyMotionMap const> bodies) const {
  if (!(cortex_ && spec_.fiber_cortex) && !spec_.fiber_body) return;
  parallel_for("StericRepulsion::hold", static_cast<long>(fibers.count()),
               [&](long i) { hold(fibers, static_cast<std::size_t>(i), u, bodies); });
}

ContactLoad StericRepulsion::on_body(std::size_t body, BodyMotionMap const& map) const {
  ContactLoad result;
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
  result.load = lever.transpose() * (spec_.body_force * (1 - contact.gap / spec_.range) * away) +
                result.resistance * map.predicted_motion();
  return result;
}

}  // namespace asterflow

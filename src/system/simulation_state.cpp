// What a simulation stores: states for output (docs/trajectory.md) and all that an exact restart needs.

#include "base/error.hpp"
#include "fiber/fiber_basis.hpp"
#include "system/simulation.hpp"

namespace asterflow {
namespace {

NamedArray numbers(std::string name, std::vector<double> values) {
  return NamedArray::of(std::move(name), std::move(values), "");
}

NamedArray directions(std::string name, Recycling::Directions const& d) {
  return {std::move(name), {static_cast<std::size_t>(d.cols()), static_cast<std::size_t>(d.rows())},
          std::vector<double>(d.data(), d.data() + d.size()), "", true};
}

NamedArray const& find_array(std::vector<NamedArray> const& arrays, std::string const& name) {
  for (auto const& array : arrays)
    if (array.name == name) return array;
  throw SceneError("the stored state lacks " + name + ": it was not written by this program, or by another version");
}

std::vector<double> const& find(std::vector<NamedArray> const& arrays, std::string const& name) {
  return std::get<std::vector<double>>(find_array(arrays, name).values);
}

Recycling::Directions find_directions(std::vector<NamedArray> const& arrays, std::string const& name) {
  auto const& shape = find_array(arrays, name).shape;
  auto const& values = find(arrays, name);
  return Eigen::Map<Eigen::MatrixXd const>(values.data(), static_cast<Eigen::Index>(shape.at(1)),
                                           static_cast<Eigen::Index>(shape.at(0)))
      .cast<float>();
}

PointArray find_points(std::vector<NamedArray> const& arrays, std::string const& name) {
  auto const points = as_points(ConstVector(find(arrays, name)));
  return {points.begin(), points.end()};
}

}  // namespace

std::vector<NamedArray> Simulation::body_frame() const {
  PointArray positions, velocities, angular, contact_forces, contact_torques, applied_forces, applied_torques, flow_positions;
  std::vector<double> orientations, flow_orientations;
  for (auto const& body : bodies_) {
    positions.push_back(body.pose().position);
    auto const& q = body.orientation();
    orientations.insert(orientations.end(), {q.w(), q.x(), q.y(), q.z()});
    velocities.push_back(to_vec3(body.motion().head<3>()));
    angular.push_back(to_vec3(body.motion().tail<3>()));
  }
  for (Vector6 const& contact : contacts_) {
    contact_forces.push_back(to_vec3(contact.head<3>()));
    contact_torques.push_back(to_vec3(contact.tail<3>()));
  }
  for (Vector6 const& applied : applied_) {
    applied_forces.push_back(to_vec3(applied.head<3>()));
    applied_torques.push_back(to_vec3(applied.tail<3>()));
  }
  for (RigidPose const& pose : last_.poses) {
    Eigen::Quaterniond const q(pose.rotation);
    flow_positions.push_back(pose.position);
    flow_orientations.insert(flow_orientations.end(), {q.w(), q.x(), q.y(), q.z()});
  }
  contact_forces.resize(bodies_.size());  // none before the first step
  contact_torques.resize(bodies_.size());
  applied_forces.resize(bodies_.size());
  applied_torques.resize(bodies_.size());
  return {NamedArray::of("body/position", positions, "um"),
          {"body/orientation", {bodies_.size(), 4}, orientations, ""},
          NamedArray::of("body/flow_position", flow_positions, "um"),
          {"body/flow_orientation", {last_.poses.size(), 4}, flow_orientations, ""},
          NamedArray::of("body/velocity", velocities, "um/s"),
          NamedArray::of("body/angular_velocity", angular, "rad/s"),
          NamedArray::of("body/contact_force", contact_forces, "pN"),
          NamedArray::of("body/contact_torque", contact_torques, "pN um"),
          NamedArray::of("body/applied_force", applied_forces, "pN"),
          NamedArray::of("body/applied_torque", applied_torques, "pN um")};
}

std::vector<NamedArray> Simulation::fiber_frame() const {
  std::vector<std::int64_t> first{0}, holders;
  std::vector<double> lengths, weights, tension;
  PointArray minus_ends, plus_ends, positions;
  PointArray forces = last_.force_density;
  for (std::size_t i = 0; i < fibers_.count(); ++i) {
    auto const& shape = fibers_.shape(i);
    FiberBasis const& basis = fiber_basis(fibers_.properties(i).n_node);
    std::vector<double> s;
    for (int k = 0; k < basis.n_node; ++k) {
      s.push_back(basis.gauss.nodes[k] * shape.length);
      weights.push_back(basis.gauss.weights[k] * shape.length);
    }
    std::size_t const n = positions.size();
    positions.resize(n + s.size());
    sample(shape, s, Points(positions).subspan(n), {});
    first.push_back(static_cast<std::int64_t>(positions.size()));
    lengths.push_back(shape.length);
    minus_ends.push_back(shape.minus_end);
    plus_ends.push_back(plus_end(shape));
    holders.push_back(fibers_.site(i).is_attached() ? fibers_.site(i).body : -1);
    ConstVector const own = fibers_.tension(i);
    tension.insert(tension.end(), own.begin(), own.end());
    tension.resize(positions.size());  // none before the first step, as the forces
  }
  forces.resize(positions.size());
  ConstPoints const flow_positions = last_.fiber_nodes.empty() ? positions : last_.fiber_nodes;
  return {NamedArray::of("fiber/first", first),
          NamedArray::of("fiber/length", lengths, "um"),
          NamedArray::of("fiber/body", holders),
          NamedArray::of("fiber/minus_end", minus_ends, "um"),
          NamedArray::of("fiber/plus_end", plus_ends, "um"),
          NamedArray::of("fiber/position", positions, "um"),
          NamedArray::of("fiber/weight", weights, "um"),
          NamedArray::of("fiber/tension", tension, "pN"),
          NamedArray::of("fiber/force_density", forces, "pN/um"),
          NamedArray::of("fiber/flow_position", flow_positions, "um")};
}

std::vector<NamedArray> Simulation::fiber_end_frame() const {
  std::vector<std::int64_t> states;
  std::vector<double> motors;
  PointArray plus_end_forces, minus_end_forces, minus_end_torques, contact_forces, contact_torques;
  for (std::size_t i = 0; i < fibers_.count(); ++i) {
    auto const& ends = fibers_.ends(i);
    states.push_back(static_cast<std::int64_t>(tip_state(i)));
    plus_end_forces.push_back(ends.plus_end);
    minus_end_forces.push_back(ends.minus_end);
    minus_end_torques.push_back(ends.minus_end_torque);
    contact_forces.push_back(ends.contact);
    contact_torques.push_back(ends.contact_torque);
    motors.push_back(fibers_.load(i).motor);
  }
  return {NamedArray::of("fiber/tip_state", states),
          NamedArray::of("fiber/plus_end_force", plus_end_forces, "pN"),
          NamedArray::of("fiber/minus_end_force", minus_end_forces, "pN"),
          NamedArray::of("fiber/minus_end_torque", minus_end_torques, "pN um"),
          NamedArray::of("fiber/contact_force", contact_forces, "pN"),
          NamedArray::of("fiber/contact_torque", contact_torques, "pN um"),
          NamedArray::of("fiber/motor_load", motors, "pN/um")};
}

std::vector<NamedArray> Simulation::frame() const {
  std::vector<NamedArray> arrays;
  if (!bodies_.empty()) append(arrays, body_frame());
  if (fibers_.count() > 0) append(arrays, fiber_frame()), append(arrays, fiber_end_frame());
  if (radiation_) {
    std::size_t const n_fiber_node = std::min(fibers_.node_count(), last_.incident.size());
    PointArray incident(last_.incident.begin() + static_cast<long>(n_fiber_node), last_.incident.end());
    append(arrays, {NamedArray::of("flow/incident", incident, "um/s")});
  }
  return arrays;
}

std::vector<NamedArray> Simulation::restart() const {
  std::vector<NamedArray> arrays{numbers("step/next", {dt_, last_dt_})};
  if (!bodies_.empty()) {
    std::vector<double> states;
    for (auto const& body : bodies_) {
      auto const state = body.state();
      states.insert(states.end(), state.begin(), state.end());
    }
    arrays.push_back({"body/state", {bodies_.size(), RigidBody::n_state}, states, ""});
  }
  if (fibers_.count() > 0) append(arrays, fibers_.state());
  if (plus_ends_) append(arrays, plus_ends_->state());
  append(arrays, {NamedArray::of("flow/incident", last_.incident, "um/s"),
          NamedArray::of("flow/incident_before", before_.incident, "um/s"),
          NamedArray::of("flow/force_density", last_.force_density, "pN/um"),
          directions("solver/changes", memory_.changes()), directions("solver/images", memory_.images()),
          numbers("solver/memory", {memory_.cost_without(), double(memory_.solves_when_full())})});
  return arrays;
}

void Simulation::restore(double time, std::vector<NamedArray> const& arrays) {
  time_ = time;
  auto const& steps = find(arrays, "step/next");
  dt_ = steps.at(0);
  last_dt_ = steps.at(1);
  if (!bodies_.empty()) {
    auto const& states = find(arrays, "body/state");
    if (states.size() != bodies_.size() * RigidBody::n_state) throw SceneError("the stored state has other bodies");
    for (std::size_t b = 0; b < bodies_.size(); ++b)
      bodies_[b].set_state(
          Eigen::Map<Eigen::Matrix<double, RigidBody::n_state, 1> const>(&states[b * RigidBody::n_state]));
  }
  if (fibers_.count() > 0) fibers_.restore(arrays);
  if (plus_ends_) plus_ends_->restore(arrays);
  last_.incident = find_points(arrays, "flow/incident");
  before_.incident = find_points(arrays, "flow/incident_before");
  last_.force_density = find_points(arrays, "flow/force_density");
  auto const& cost = find(arrays, "solver/memory");
  memory_.restore(find_directions(arrays, "solver/changes"), find_directions(arrays, "solver/images"), cost.at(0),
                  static_cast<int>(cost.at(1)));
}

}  // namespace asterflow

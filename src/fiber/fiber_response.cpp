#include "fiber/fiber_response.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <array>

namespace asterflow {

// Of a node that moves with u + c (I + t t) f for one time level.
Vec3d FiberResponse::displacement(int i, Vec3d u, Vec3d force) const {
  Vec3d const velocity = u + step_.mobility * (force + dot(tangents_[i], force) * tangents_[i]);
  return (1.0 / rate_) * velocity;
}

Vec3d FiberResponse::relative_motion(int i, Vector6 const& q) const {
  Vec3d const motion = carried(q).at(nodes_[i]);
  if (!step_.node_loads[i].is_internal) return motion;
  BodyMotionMap const& body = *step_.body;
  Vec3d const turn = to_vec3(body.turn_per_angular_velocity * q.tail<3>());
  return motion - body.displacement_per_velocity * to_vec3(q.head<3>()) - cross(turn, nodes_[i] - body.predicted.position);
}

void FiberResponse::total_force(ConstPoints u, Vector6 const& q, Points f) const {
  Vector6 not_wanted = Vector6::Zero();
  add_affine(f, not_wanted);
  add_linear(u, q, f, nullptr);
  for (std::size_t i = 0; i < f.size(); ++i) f[i] += step_.load.motor * tangents_[i];
}

void FiberResponse::node_positions(ConstPoints u, Vector6 const& q, Points positions) const {
  std::array<Vec3d, max_fiber_nodes> force{};
  total_force(u, q, Points(force.data(), positions.size()));
  for (std::size_t i = 0; i < positions.size(); ++i)
    positions[i] = nodes_[i] + displacement(i, u[i] - velocity_[i], force[i]);
}

Vec3d FiberResponse::node_force(int i, Vec3d u, Vector6 const& q, Vec3d total) const {
  NodeLoad const& load = step_.node_loads[i];
  Vec3d moved = displacement(i, u - velocity_[i], total);
  if (load.is_internal) {
    Vector6 const change = q - predicted_motion();
    moved += relative_motion(i, change) - carried(change).at(nodes_[i]);
  }
  return load.force - load.stiffness * moved;
}

// Whether a load on the node pulls at the body through the fiber: not one between the two.
bool FiberResponse::has_external_load(int i) const { return !step_.node_loads.empty() && !step_.node_loads[i].is_internal; }

bool FiberResponse::has_tip_spring() const { return !step_.tip.stiffness.isZero(0.0); }

// What the spring at the plus end does to the body when the fiber responds.
void FiberResponse::add_spring_load(Unknowns response, Vector6 const& q, Vector6& load) const {
  lower_.triangularView<Eigen::Lower>().transpose().solveInPlace(response);
  Vec3d const tip = to_vec3(tip_motion_ * response) + carried(q).at(plus_end_);
  add_body_load(plus_end_, -(step_.tip.stiffness * tip), load);
}

Vec3d FiberResponse::drag(int i, Vec3d velocity) const {
  return (1.0 / step_.mobility) * (velocity - (0.5 * dot(tangents_[i], velocity)) * tangents_[i]);
}

Vec3d FiberResponse::applied(int i) const { return step_.load.external + step_.load.motor * tangents_[i]; }

FiberResponse::Carried FiberResponse::carried(Vector6 const& q) const {
  if (!step_.body) return {};
  BodyMotionMap const& body = *step_.body;
  Vec3d const shift = body.displacement_per_velocity * to_vec3(q.head<3>());
  Vec3d const turn = to_vec3(body.turn_per_angular_velocity * q.tail<3>());
  if (step_.minus_end == MinusEnd::clamped) return {shift - cross(turn, body.predicted.position), turn};
  return {shift + cross(turn, minus_end_ - body.predicted.position), {}};
}

Vector6 FiberResponse::predicted_motion() const {
  return step_.body ? step_.body->predicted_motion() : Vector6(Vector6::Zero());
}

void FiberResponse::add_body_load(Vec3d point, Vec3d force, Vector6& load) const {
  load += load_of_force(force, point - step_.body->predicted.position);
}

// f = (a0/dt) (1/w) reduced_drag^T reduced
void FiberResponse::respond(Eigen::Ref<Eigen::VectorXd const> reduced, Points f) const {
  flat(f).noalias() = reduced_.leftCols(static_cast<Eigen::Index>(3 * f.size())).transpose() * reduced;
  for (std::size_t i = 0; i < f.size(); ++i) f[i] *= rate_ / weights_[static_cast<Eigen::Index>(i)];
}

void FiberResponse::add_linear(ConstPoints u, Vector6 const& q, Points f, Vector6* load) const {
  int const n = step_.basis->n_node;
  std::array<Vec3d, max_fiber_nodes> change;
  Unknowns reduced(n_unknown_);
  reduced.noalias() = reduced_.leftCols(3 * n) * flat(u);
  if (step_.body) reduced.noalias() -= reduced_.rightCols<6>() * q;
  respond(reduced, Points(change.data(), n));
  Carried const body = carried(q);
  for (int i = 0; i < n; ++i) {
    change[i] += drag(i, rate_ * body.at(nodes_[i]) - u[i]);
    f[i] += change[i];
  }
  if (!step_.body || !load) return;
  for (int i = 0; i < n; ++i) {
    add_body_load(nodes_[i], -weights_[i] * change[i], *load);
    add_node_load(i, u[i], change[i], *load);
  }
  if (has_tip_spring()) add_spring_load(reduced, q, *load);
}

void FiberResponse::add_load(ConstPoints u, Vector6& load) const {
  if (step_.body) load.noalias() += load_of_flow_ * flat(u);
}

void FiberResponse::add_affine(Points f, Vector6& load) const {
  int const n = step_.basis->n_node;
  Vector6 const q = -predicted_motion();
  std::array<Vec3d, max_fiber_nodes> total;
  Unknowns reduced = reduced_.col(3 * n);
  if (step_.body) reduced.noalias() -= reduced_.rightCols<6>() * q;
  respond(reduced, Points(total.data(), n));
  Carried const body = carried(q);
  for (int i = 0; i < n; ++i) {
    total[i] += drag(i, rate_ * body.at(nodes_[i]) + velocity_[i]);
    f[i] += total[i] - step_.load.motor * tangents_[i];
    if (!step_.body) continue;
    add_body_load(nodes_[i], weights_[i] * (applied(i) - total[i]), load);
    if (!has_external_load(i)) continue;
    add_body_load(nodes_[i], weights_[i] * step_.node_loads[i].force, load);
    add_node_load(i, -velocity_[i], total[i], load);
  }
  if (!step_.body) return;
  add_body_load(plus_end_, step_.tip.force - step_.tip.stiffness * (plus_end_ - step_.tip.anchor), load);
  if (has_tip_spring()) add_spring_load(reduced, q, load);
}

// What the spring on a node does to the body when flow and force move the node.
void FiberResponse::add_node_load(int i, Vec3d u, Vec3d force, Vector6& load) const {
  if (!has_external_load(i)) return;
  Vec3d const moved = displacement(i, u, force);
  add_body_load(nodes_[i], -weights_[i] * (step_.node_loads[i].stiffness * moved), load);
}

FiberResponse::Unknowns FiberResponse::unknowns(ConstPoints u, Vector6 const& q) const {
  int const n = step_.basis->n_node;
  Unknowns y = reduced_.col(3 * n);
  y.noalias() += reduced_.leftCols(3 * n) * flat(u);
  if (step_.body) y.noalias() -= reduced_.rightCols<6>() * (q - predicted_motion());
  lower_.triangularView<Eigen::Lower>().transpose().solveInPlace(y);
  return y;
}

Vec3d FiberResponse::tip_position(ConstPoints u, Vector6 const& q) const {
  Vec3d tip = plus_end_ + to_vec3(tip_motion_ * unknowns(u, q));
  if (step_.body) tip += carried(q - predicted_motion()).at(plus_end_);
  return tip;
}

TipAnswer FiberResponse::tip_answer(ConstPoints u, Vector6 const& q) const {
  TipAnswer answer{tip_position(u, q)};
  Eigen::Matrix<double, Eigen::Dynamic, 3, 0, max_unknowns, 3> reduced = tip_motion_.transpose();
  lower_.triangularView<Eigen::Lower>().solveInPlace(reduced);
  answer.compliance.noalias() = reduced.transpose() * reduced;
  return answer;
}

Vec3d FiberResponse::tip_force(ConstPoints u, Vector6 const& q) const {
  return step_.tip.force - step_.tip.stiffness * (tip_position(u, q) - step_.tip.anchor);
}

EndForces FiberResponse::internal_forces(ConstPoints u, Vector6 const& q, Centreline const& shape,
                                         Vector tension) const {
  FiberBasis const& basis = *step_.basis;
  int const n = basis.n_node;
  std::array<Vec3d, max_fiber_nodes> force{};  // per length, on the fluid
  total_force(u, q, Points(force.data(), n));
  EndForces ends;
  for (int i = 0; i < n; ++i) {  // elastic part
    Vec3d const other = step_.node_loads.empty() ? Vec3d{} : node_force(i, u[i], q, force[i]);
    if (has_external_load(i)) {
      ends.contact += weights_[i] * other;
      ends.contact_torque += weights_[i] * cross(nodes_[i] - minus_end_, other);
    }
    force[i] -= applied(i) + other;
  }
  Vec3d const tip = tip_force(u, q);
  for (int i = 0; i < n; ++i) {
    Vec3d internal = tip, tangent, bend;
    for (int j = 0; j < n; ++j) internal -= (length_ * basis.remainder(i, j)) * force[j];
    for (int j = 0; j < basis.n_tangent; ++j) {
      tangent += basis.tangent(i, j) * shape.tangents[j];
      bend += (basis.derivative(i, j) / length_) * shape.tangents[j];
    }
    tension[i] = dot(internal, tangent) - step_.bending_rigidity * dot(bend, bend);
  }
  ends.plus_end = ends.minus_end = tip;
  ends.minus_end_torque = cross(plus_end_ - minus_end_, tip);
  for (int i = 0; i < n; ++i) {
    ends.minus_end -= weights_[i] * force[i];
    ends.minus_end_torque -= weights_[i] * cross(nodes_[i] - minus_end_, force[i]);
  }
  return ends;
}

void FiberResponse::advance(ConstPoints u, Vector6 const& q, RigidPose const* new_pose, Centreline const& predicted,
                            Centreline& shape) const {
  Unknowns const y = unknowns(u, q);
  std::size_t const m = predicted.tangents.size();
  shape.length = length_;
  shape.minus_end = minus_end_;
  shape.tangents = predicted.tangents;
  Matrix3 rotation = Matrix3::Identity();
  if (step_.body) {
    Matrix3 const turn = new_pose->rotation * step_.body->predicted.rotation.transpose();
    shape.minus_end = new_pose->position + turn * (minus_end_ - step_.body->predicted.position);
    if (step_.minus_end == MinusEnd::clamped) rotation = turn;
  }
  for (int k = 0; k < first_rotation_; ++k) shape.minus_end[k] += y[k];
  if (first_turn_ > first_rotation_) {
    Vec3d const turn = y[first_rotation_] * directions_[1] - y[first_rotation_ + 1] * directions_[0];
    double const angle = norm(turn);
    if (angle > 0) rotation = Eigen::AngleAxisd(angle, to_eigen(turn / angle)).toRotationMatrix();
  }
  for (std::size_t j = 0; j < m; ++j) {
    Vec3d t = predicted.tangents[j];
    for (int k = 0; k < 2 && j > 0; ++k) t += y[first_turn_ + 2 * (j - 1) + k] * directions_[2 * j + k];
    shape.tangents[j] = normalized(rotation * t);
  }
}

}  // namespace asterflow

#include "fiber/fiber_response.hpp"

#include "base/error.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace asterflow {

namespace {

using Map = Eigen::Map<Eigen::MatrixXd>;

// A matrix in this thread's memory, kept from fiber to fiber.
template <int Slot>
Map scratch(Eigen::Index rows, Eigen::Index columns) {
  thread_local std::vector<double> memory;
  if (memory.size() < static_cast<std::size_t>(rows * columns)) memory.resize(rows * columns);
  return {memory.data(), rows, columns};
}

// Any unit vector normal to the unit vector t.
Vec3d any_normal(Vec3d t) {
  bool const along_x = std::abs(t.x) > 0.6;
  return normalized(cross(t, along_x ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0}));
}

// Parallel transport of the normal vector n from the unit tangent `from` to the unit tangent `to`.
Vec3d transported(Vec3d n, Vec3d from, Vec3d to) {
  double const c = 1.0 + dot(from, to);
  if (c < 1e-6) return any_normal(to);
  Vec3d const moved = n - (dot(n, to) / c) * (from + to);
  return normalized(moved - dot(moved, to) * to);
}

}  // namespace

void FiberResponse::prepare(FiberStep const& step, Centreline const& predicted, ConstPoints history, Points nodes,
                            Vector weights) {
  step_ = step;
  set_geometry(predicted, history, nodes, weights);
  set_directions(predicted.tangents);
  factorise(predicted);
  set_body_resistance();
  set_load_of_flow();
}

void FiberResponse::set_geometry(Centreline const& predicted, ConstPoints history, Points nodes, Vector weights) {
  FiberBasis const& basis = *step_.basis;
  int const n = basis.n_node, m = basis.n_tangent;
  length_ = predicted.length;
  rate_ = step_.scheme.a0 / step_.scheme.dt;
  minus_end_ = predicted.minus_end;
  plus_end_ = asterflow::plus_end(predicted);
  weights_ = length_ * basis.gauss.weights;
  nodes_.assign(n, minus_end_);
  tangents_.assign(n, Vec3d{});
  velocity_.resize(n);
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i) {
      nodes_[i] += (length_ * basis.position(i, j)) * predicted.tangents[j];
      tangents_[i] += basis.tangent(i, j) * predicted.tangents[j];
    }
  for (int i = 0; i < n; ++i) {
    tangents_[i] = normalized(tangents_[i]);
    velocity_[i] = (step_.scheme.a0 * nodes_[i] - history[i]) / step_.scheme.dt;
    nodes[i] = nodes_[i];
    weights[i] = weights_[i];
  }
}

void FiberResponse::set_directions(PointArray const& tangents) {
  std::size_t const m = tangents.size();
  directions_.resize(2 * m);
  directions_[0] = any_normal(tangents[0]);
  for (std::size_t j = 0; j < m; ++j) {
    if (j > 0) directions_[2 * j] = transported(directions_[2 * j - 2], tangents[j - 1], tangents[j]);
    directions_[2 * j + 1] = cross(tangents[j], directions_[2 * j]);
  }
}

void FiberResponse::set_motions(Eigen::Ref<Eigen::MatrixXd> motions) {
  FiberBasis const& basis = *step_.basis;
  int const n = basis.n_node;
  auto const column = [&](int unknown, auto const& motion_of_node, Vec3d motion_of_tip) {
    for (int i = 0; i < n; ++i) {
      Vec3d const motion = motion_of_node(i);
      for (int k = 0; k < 3; ++k) motions(3 * i + k, unknown) = motion[k];
    }
    tip_motion_.col(unknown) = to_eigen(motion_of_tip);
  };
  tip_motion_.resize(3, n_unknown_);
  for (int k = 0; k < first_rotation_; ++k) {
    Vec3d e;
    e[k] = 1.0;
    column(
        k, [&](int) { return e; }, e);
  }
  for (int k = first_rotation_; k < first_turn_; ++k) {  // axis t x n turns t towards n
    Vec3d const axis = k == first_rotation_ ? directions_[1] : -directions_[0];
    column(
        k, [&](int i) { return cross(axis, nodes_[i] - minus_end_); }, cross(axis, plus_end_ - minus_end_));
  }
  for (int k = first_turn_; k < n_unknown_; ++k) {
    int const direction = 2 + k - first_turn_, j = direction / 2;
    Vec3d const d = length_ * directions_[direction];
    column(
        k, [&](int i) { return basis.position(i, j) * d; }, basis.lobatto.weights[j] * d);
  }
}

// Lower triangle of E int dX_ss . X_ss ds + int T dX_s . X_s ds for the turns of the tangents.
void FiberResponse::add_elasticity(Eigen::Ref<Eigen::MatrixXd> matrix) const {
  FiberBasis const& basis = *step_.basis;
  Map stiffness = scratch<2>(basis.n_tangent, basis.n_tangent), stretched = scratch<3>(basis.n_node, basis.n_tangent);
  stiffness = (step_.bending_rigidity / length_) * basis.bending;
  if (std::any_of(step_.tension.begin(), step_.tension.end(), [](double t) { return t > 0; })) {
    for (int i = 0; i < basis.n_node; ++i)
      stretched.row(i) = (weights_[i] * std::max(step_.tension[i], 0.0)) * basis.tangent.row(i);
    stiffness.noalias() += basis.tangent.transpose() * stretched;
  }
  for (int column = first_turn_; column < n_unknown_; ++column) {
    int const b = 2 + column - first_turn_;
    for (int row = column; row < n_unknown_; ++row) {
      int const a = 2 + row - first_turn_;
      matrix(row, column) += stiffness(a / 2, b / 2) * dot(directions_[a], directions_[b]);
    }
  }
}

// The rows of the rotations in int T dX_s . X_s ds. Only a force on an end makes them stiff; without one they are left
// out, so that no torque appears on a free fiber.
void FiberResponse::add_tension_of_rotations(Eigen::Ref<Eigen::MatrixXd> matrix) const {
  bool const has_end_force = dot(step_.tip.force, step_.tip.force) > 0 || has_tip_spring();
  if (step_.tension.empty() || (step_.minus_end == MinusEnd::free && !has_end_force)) return;
  FiberBasis const& basis = *step_.basis;
  for (int k = first_rotation_; k < first_turn_; ++k) {
    Vec3d const axis = k == first_rotation_ ? directions_[1] : -directions_[0];
    for (int i = 0; i < basis.n_node; ++i) {
      Vec3d const pull = (weights_[i] * std::max(step_.tension[i], 0.0)) * cross(axis, tangents_[i]);
      for (int l = k; l < first_turn_; ++l)
        matrix(l, k) += dot(cross(l == first_rotation_ ? directions_[1] : -directions_[0], tangents_[i]), pull);
      for (int l = first_turn_; l < n_unknown_; ++l) {
        int const direction = 2 + l - first_turn_;
        matrix(l, k) += basis.tangent(i, direction / 2) * dot(directions_[direction], pull);
      }
    }
  }
}

// Virtual work of the drag at the predicted velocity without incident flow, of the applied forces and of the bending
// moments of the predicted shape.
void FiberResponse::set_forcing(PointArray const& tangents, Eigen::Ref<Eigen::MatrixXd const> motions,
                                Eigen::Ref<Eigen::VectorXd> forcing) const {
  int const n = step_.basis->n_node, m = step_.basis->n_tangent;
  std::array<Vec3d, max_fiber_nodes> force;
  for (int i = 0; i < n; ++i) force[i] = weights_[i] * (applied(i) - drag(i, velocity_[i]));
  for (std::size_t i = 0; i < step_.node_loads.size(); ++i) force[i] += weights_[i] * step_.node_loads[i].force;
  forcing.noalias() = motions.transpose() * flat(ConstPoints(force.data(), n));
  Vec3d const tip = step_.tip.force - step_.tip.stiffness * (plus_end_ - step_.tip.anchor);
  forcing.noalias() += tip_motion_.transpose() * to_eigen(tip);
  double const stiffness = step_.bending_rigidity / length_;
  for (int j = 1; j < m; ++j) {
    Vec3d moment;
    for (int k = 0; k < m; ++k) moment += step_.basis->bending(j, k) * (tangents[k] - tangents[j]);
    for (int k = 0; k < 2; ++k)
      forcing[first_turn_ + 2 * (j - 1) + k] -= stiffness * dot(directions_[2 * j + k], moment);
  }
}

void FiberResponse::factorise(Centreline const& predicted) {
  int const n = step_.basis->n_node;
  first_rotation_ = step_.minus_end == MinusEnd::free ? 3 : 0;
  first_turn_ = first_rotation_ + (step_.minus_end == MinusEnd::clamped ? 0 : 2);
  n_unknown_ = first_turn_ + 2 * (step_.basis->n_tangent - 1);

  Map motions = scratch<0>(3 * n, n_unknown_), drags = scratch<1>(3 * n, n_unknown_);
  set_motions(motions);
  for (int k = 0; k < n_unknown_; ++k)
    for (int i = 0; i < n; ++i) {
      Vec3d const d = weights_[i] * drag(i, {motions(3 * i, k), motions(3 * i + 1, k), motions(3 * i + 2, k)});
      for (int j = 0; j < 3; ++j) drags(3 * i + j, k) = d[j];
    }
  lower_.resize(n_unknown_, n_unknown_);
  lower_.noalias() = rate_ * (drags.transpose() * motions);
  lower_.noalias() += tip_motion_.transpose() * step_.tip.stiffness * tip_motion_;
  add_node_stiffness(motions, lower_);
  add_elasticity(lower_);
  add_tension_of_rotations(lower_);

  reduced_.resize(n_unknown_, 3 * n + 7);
  reduced_.leftCols(3 * n) = drags.transpose();
  set_forcing(predicted.tangents, motions, reduced_.col(3 * n));
  set_body_columns(motions);
  Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> const llt(lower_);
  if (llt.info() != Eigen::Success)
    throw NumericalError("the implicit problem of a fiber is not positive definite (length " + std::to_string(length_) +
                         " um, dt " + std::to_string(step_.scheme.dt) + " s)");
  llt.matrixL().solveInPlace(reduced_);
}

// Virtual work of the drag and of the spring at the plus end for the motion of the body; motions [3 n_node, 6], um.
void FiberResponse::set_body_columns(Eigen::Ref<Eigen::MatrixXd const> unknown_motions) {
  int const n = step_.basis->n_node;
  auto columns = reduced_.rightCols<6>();
  columns.setZero();
  if (!step_.body) return;
  Map motions = scratch<2>(3 * n, 6);
  for (int k = 0; k < 6; ++k) {
    Vector6 const q = Vector6::Unit(k);
    for (int i = 0; i < n; ++i) motions.col(k).segment<3>(3 * i) = to_eigen(body_motion(q, nodes_[i]));
    if (has_tip_spring())
      columns.col(k) = tip_motion_.transpose() * (step_.tip.stiffness * to_eigen(body_motion(q, plus_end_)));
  }
  columns.noalias() += rate_ * (reduced_.leftCols(3 * n) * motions);
  for (std::size_t i = 0; i < step_.node_loads.size(); ++i) {
    Matrix3 const stiffness = weights_[i] * step_.node_loads[i].stiffness;
    if (stiffness.isZero(0.0)) continue;
    for (int k = 0; k < 6; ++k)
      columns.col(k) += unknown_motions.middleRows<3>(3 * i).transpose() *
                        (stiffness * to_eigen(relative_motion(i, Vector6::Unit(k))));
  }
}

// Virtual work of the springs on the nodes.
void FiberResponse::add_node_stiffness(Eigen::Ref<Eigen::MatrixXd const> motions,
                                       Eigen::Ref<Eigen::MatrixXd> matrix) const {
  for (std::size_t i = 0; i < step_.node_loads.size(); ++i) {
    Matrix3 const stiffness = weights_[i] * step_.node_loads[i].stiffness;
    if (stiffness.isZero(0.0)) continue;
    auto const motion = motions.middleRows<3>(3 * i);
    matrix.noalias() += motion.transpose() * (stiffness * motion);
  }
}

// Of a node that moves with u + c (I + t t) f for one time level.
Vec3d FiberResponse::displacement(int i, Vec3d u, Vec3d force) const {
  Vec3d const velocity = u + step_.mobility * (force + dot(tangents_[i], force) * tangents_[i]);
  return (1.0 / rate_) * velocity;
}

Vec3d FiberResponse::relative_motion(int i, Vector6 const& q) const {
  Vec3d const motion = body_motion(q, nodes_[i]);
  if (!step_.node_loads[i].is_internal) return motion;
  BodyMotionMap const& body = *step_.body;
  Vec3d const turn = to_vec3(body.turn_per_angular_velocity * q.tail<3>());
  return motion - body.displacement_per_velocity * to_vec3(q.head<3>()) - cross(turn, nodes_[i] - body.predicted.position);
}

void FiberResponse::total_force(ConstPoints u, Vector6 const& q, Points f) const {
  Vector6 no_load = Vector6::Zero();
  add_affine(f, no_load);
  add_linear(u, q, f, no_load);
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
    moved += relative_motion(i, change) - body_motion(change, nodes_[i]);
  }
  return load.force - load.stiffness * moved;
}

// -load of unit motions of the body, all six at once.
void FiberResponse::set_body_resistance() {
  body_resistance_.setZero();
  if (!step_.body) return;
  int const n = step_.basis->n_node;
  Map part = scratch<2>(3 * n, 6);
  part.noalias() = reduced_.leftCols(3 * n).transpose() * reduced_.rightCols<6>();
  for (int k = 0; k < 6; ++k) {
    Vector6 const q = Vector6::Unit(k);
    Vector6 load = Vector6::Zero();
    for (int i = 0; i < n; ++i) {
      Vec3d const drag_work = weights_[i] * drag(i, body_motion(q, nodes_[i]));
      Vec3d const force = rate_ * (drag_work - to_vec3(part.col(k).segment<3>(3 * i)));
      add_body_load(nodes_[i], -force, load);
      add_node_load(i, {}, (1.0 / weights_[i]) * force, load);
    }
    if (has_tip_spring()) add_spring_load(-reduced_.col(3 * n + 1 + k), q, load);
    body_resistance_.col(k) = -load;
  }
}

// Row k: minus the work of R u, and of the springs at the plus end and on the nodes as the fiber yields to u, in the body's
// k-th unit motion g,
//   D_k u = -g . w R u - g(L) . K dX(L) - g . w K_i dX_i,   R = (a0/dt) (1/w) B^T B - drag,   B = lower^-1 drag^T;
// a node moves by dX_i = (1/w) c (I + t t) (B^T B u)_i.
void FiberResponse::set_load_of_flow() {
  if (!step_.body) return;
  int const n = step_.basis->n_node;
  Map generators = scratch<2>(3 * n, 6);
  Eigen::Matrix<double, 3, 6> at_tip;
  load_of_flow_.resize(6, 3 * n);
  for (int k = 0; k < 6; ++k) {
    for (int i = 0; i < n; ++i) {
      Vec3d const g = velocity_of_motion(Vector6::Unit(k), nodes_[i] - step_.body->predicted.position);
      Vec3d worked = rate_ * g;
      if (has_external_load(i)) worked += rate_ * displacement(i, {}, step_.node_loads[i].stiffness * g);
      generators.col(k).segment<3>(3 * i) = to_eigen(worked);
      load_of_flow_.row(k).segment<3>(3 * i) = to_eigen(weights_[i] * drag(i, g)).transpose();
    }
    at_tip.col(k) = to_eigen(velocity_of_motion(Vector6::Unit(k), plus_end_ - step_.body->predicted.position));
  }
  Map yielding = scratch<3>(n_unknown_, 6);
  yielding.noalias() = reduced_.leftCols(3 * n) * generators;
  if (has_tip_spring()) {
    Eigen::MatrixXd spring = tip_motion_.transpose() * (step_.tip.stiffness.transpose() * at_tip);
    lower_.triangularView<Eigen::Lower>().solveInPlace(spring);
    yielding += spring;
  }
  load_of_flow_.noalias() -= yielding.transpose() * reduced_.leftCols(3 * n);
}

// Whether a load on the node pulls at the body through the fiber: not one between the two.
bool FiberResponse::has_external_load(int i) const { return !step_.node_loads.empty() && !step_.node_loads[i].is_internal; }

bool FiberResponse::has_tip_spring() const { return !step_.tip.stiffness.isZero(0.0); }

// What the spring at the plus end does to the body when the fiber responds.
void FiberResponse::add_spring_load(Unknowns response, Vector6 const& q, Vector6& load) const {
  lower_.triangularView<Eigen::Lower>().transpose().solveInPlace(response);
  Vec3d const tip = to_vec3(tip_motion_ * response) + body_motion(q, plus_end_);
  add_body_load(plus_end_, -(step_.tip.stiffness * tip), load);
}

Vec3d FiberResponse::drag(int i, Vec3d velocity) const {
  return (1.0 / step_.mobility) * (velocity - (0.5 * dot(tangents_[i], velocity)) * tangents_[i]);
}

Vec3d FiberResponse::applied(int i) const { return step_.load.external + step_.load.motor * tangents_[i]; }

Vec3d FiberResponse::body_motion(Vector6 const& q, Vec3d point) const {
  BodyMotionMap const& body = *step_.body;
  Vec3d const turn = to_vec3(body.turn_per_angular_velocity * q.tail<3>());
  Vec3d const held = step_.minus_end == MinusEnd::clamped ? point : minus_end_;
  return body.displacement_per_velocity * to_vec3(q.head<3>()) + cross(turn, held - body.predicted.position);
}

Vector6 FiberResponse::predicted_motion() const {
  return step_.body ? step_.body->predicted_motion() : Vector6(Vector6::Zero());
}

void FiberResponse::add_body_load(Vec3d point, Vec3d force, Vector6& load) const {
  load.head<3>() += to_eigen(force);
  load.tail<3>() += to_eigen(cross(point - step_.body->predicted.position, force));
}

// f += (a0/dt) ((1/w) reduced_drag^T reduced + drag(body motion)).
void FiberResponse::respond(Eigen::Ref<Eigen::VectorXd const> reduced, Vector6 const& q, Points f) const {
  int const n = step_.basis->n_node;
  std::array<Vec3d, max_fiber_nodes> part;
  flat(Points(part.data(), n)).noalias() = reduced_.leftCols(3 * n).transpose() * reduced;
  for (int i = 0; i < n; ++i) {
    f[i] += (rate_ / weights_[i]) * part[i];
    if (step_.body) f[i] += rate_ * drag(i, body_motion(q, nodes_[i]));
  }
}

void FiberResponse::add_linear(ConstPoints u, Vector6 const& q, Points f, Vector6& load) const {
  int const n = step_.basis->n_node;
  std::array<Vec3d, max_fiber_nodes> change{};
  Unknowns reduced(n_unknown_);
  reduced.noalias() = reduced_.leftCols(3 * n) * flat(u);
  if (step_.body) reduced.noalias() -= reduced_.rightCols<6>() * q;
  respond(reduced, q, Points(change.data(), n));
  for (int i = 0; i < n; ++i) {
    change[i] -= drag(i, u[i]);
    f[i] += change[i];
    if (!step_.body) continue;
    add_body_load(nodes_[i], -weights_[i] * change[i], load);
    add_node_load(i, u[i], change[i], load);
  }
  if (step_.body && has_tip_spring()) add_spring_load(reduced, q, load);
}

void FiberResponse::add_load(ConstPoints u, Vector6& load) const {
  if (step_.body) load.noalias() += load_of_flow_ * flat(u);
}

void FiberResponse::add_affine(Points f, Vector6& load) const {
  int const n = step_.basis->n_node;
  Vector6 const q = -predicted_motion();
  std::array<Vec3d, max_fiber_nodes> total{};
  Unknowns reduced = reduced_.col(3 * n);
  if (step_.body) reduced.noalias() -= reduced_.rightCols<6>() * q;
  respond(reduced, q, Points(total.data(), n));
  for (int i = 0; i < n; ++i) {
    total[i] += drag(i, velocity_[i]);
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
  if (step_.body) tip += body_motion(q - predicted_motion(), plus_end_);
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
  for (int i = 0; i < n; ++i) {  // elastic part
    Vec3d const other = step_.node_loads.empty() ? Vec3d{} : node_force(i, u[i], q, force[i]);
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
  EndForces ends{tip, tip, cross(plus_end_ - minus_end_, tip)};
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

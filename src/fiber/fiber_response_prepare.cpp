// The implicit problem of a fiber: its matrix, factorised, and what the answers need of it.

#include "fiber/fiber_response.hpp"

#include "base/error.hpp"

#include <Eigen/Cholesky>
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
    Carried const body = carried(Vector6::Unit(k));
    for (int i = 0; i < n; ++i) motions.col(k).segment<3>(3 * i) = to_eigen(body.at(nodes_[i]));
    if (has_tip_spring())
      columns.col(k) = tip_motion_.transpose() * (step_.tip.stiffness * to_eigen(body.at(plus_end_)));
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

// -load of unit motions of the body, all six at once.
void FiberResponse::set_body_resistance() {
  body_resistance_.setZero();
  if (!step_.body) return;
  int const n = step_.basis->n_node;
  Map part = scratch<2>(3 * n, 6);
  part.noalias() = reduced_.leftCols(3 * n).transpose() * reduced_.rightCols<6>();
  for (int k = 0; k < 6; ++k) {
    Vector6 const q = Vector6::Unit(k);
    Carried const body = carried(q);
    Vector6 load = Vector6::Zero();
    for (int i = 0; i < n; ++i) {
      Vec3d const drag_work = weights_[i] * drag(i, body.at(nodes_[i]));
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

}  // namespace asterflow

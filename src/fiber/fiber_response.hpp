#pragma once
// One implicit step of one inextensible fiber, by the principle of virtual work [Maxian, Mogilner & Donev 2021]:
//   int dX . [ (1/c) (I - t t / 2) (V - u) - f_applied ] ds  +  E int dX_ss . X_ss ds  -  dX(L) . F_tip  =  0
// for all inextensible motions dX that its minus end allows; V = (a0 X - history) / dt is the velocity at fixed
// material coordinate, u the incident flow, c = ln(1/(e eps^2)) / (8 pi mu) the local slender-body mobility. Free ends
// need no further condition. The unknowns y are, about a predicted shape of the new time level,
//   translation (3, if free), rotation about the minus end (2, unless clamped), and the two components of the turn of
//   every further tangent against the first one (2 (m - 1)); rigid motions bend nothing, so forces and torques balance.
// Eliminating them leaves, with q = (U, Omega) of the body that holds the minus end,
//   force density on the fluid      f     = f_0 + R u + C q          [n_node, 3]  pN/um
//   force and torque on that body   load  = l_0 + D u - S q          [6]          pN, pN um
// The matrix of y is symmetric and positive definite: A = lower lower^T. It contains the stiffness of a stretched
// fiber, int T dX_s . X_s ds, for the tension T > 0 of the step before (T < 0, which lets fibers buckle, acts through
// the predicted shape): a correction of second order in the step that removes the limit of the step by tension.

#include "base/arrays.hpp"
#include "base/rigid.hpp"
#include "base/time_scheme.hpp"
#include "fiber/centreline.hpp"
#include "fiber/fiber_basis.hpp"
#include "fiber/fiber_ends.hpp"

#include <span>

namespace asterflow {

// Everything a step of one fiber depends on.
struct FiberStep {
  FiberBasis const* basis = nullptr;
  TimeScheme scheme{};
  double bending_rigidity = 0.0;  // pN um^2
  double mobility = 0.0;          // c, um^2 / (pN s)
  MinusEnd minus_end = MinusEnd::free;
  BodyMotionMap const* body = nullptr;  // null: not attached
  FiberLoad load;
  TipLoad tip;
  std::span<NodeLoad const> node_loads;  // [n_node] pN/um; empty: none
  ConstVector tension;  // [n_node] pN, of the step before; empty: none
};

class FiberResponse {
 public:
  // `predicted`: the shape about which the step is linear, with the new length, minus end on its site.
  // `history` [n_node]: a1 X_now + a2 X_before at the nodes' material coordinates, um.
  // `nodes`, `weights` [n_node]: overwritten by the predicted positions and the lengths that the nodes stand for, um.
  void prepare(FiberStep const& step, Centreline const& predicted, ConstPoints history, Points nodes, Vector weights);

  // f += R u + C q, load += D u - S q. Without a body q and load are not touched; null: no load is wanted.
  void add_linear(ConstPoints u, Vector6 const& q, Points f, Vector6* load) const;
  // load += D u
  void add_load(ConstPoints u, Vector6& load) const;
  // f += f_0 without what the motors' cargo gives back, load += l_0.
  void add_affine(Points f, Vector6& load) const;
  // S: resistance that the fiber adds to its body when the incident flow is held fixed.
  Matrix6 const& body_resistance() const { return body_resistance_; }

  // The new shape, from the incident flow and the body's motion and (exact) pose.
  void advance(ConstPoints u, Vector6 const& q, RigidPose const* new_pose, Centreline const& predicted,
               Centreline& shape) const;

  // The plus end at the new time level, and its compliance at fixed u and q.
  TipAnswer tip_answer(ConstPoints u, Vector6 const& q) const;
  // The nodes at the new time level, um; overwritten.
  void node_positions(ConstPoints u, Vector6 const& q, Points positions) const;
  // Force on the plus end, pN, at the new time level.
  Vec3d tip_force(ConstPoints u, Vector6 const& q) const;
  // tension [n_node], pN, overwritten: T = F . X_s - E |X_ss|^2, with the force F(s) that the part beyond s exerts.
  // Returns the forces at the ends, as the load of the body has them.
  EndForces internal_forces(ConstPoints u, Vector6 const& q, Centreline const& shape, Vector tension) const;

 private:
  // As long as a fiber has unknowns, without allocation.
  static constexpr int max_unknowns = 3 + 2 * (max_fiber_nodes - max_fiber_nodes / 4);
  using Unknowns = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, max_unknowns, 1>;

  void set_geometry(Centreline const& predicted, ConstPoints history, Points nodes, Vector weights);
  void set_directions(PointArray const& tangents);
  void set_motions(Eigen::Ref<Eigen::MatrixXd> motions);
  void add_elasticity(Eigen::Ref<Eigen::MatrixXd> matrix) const;
  void add_tension_of_rotations(Eigen::Ref<Eigen::MatrixXd> matrix) const;
  void set_forcing(PointArray const& tangents, Eigen::Ref<Eigen::MatrixXd const> motions,
                   Eigen::Ref<Eigen::VectorXd> forcing) const;
  void factorise(Centreline const& predicted);
  void set_body_columns(Eigen::Ref<Eigen::MatrixXd const> motions);
  void add_node_stiffness(Eigen::Ref<Eigen::MatrixXd const> motions, Eigen::Ref<Eigen::MatrixXd> matrix) const;
  void set_body_resistance();
  void set_load_of_flow();
  bool has_external_load(int i) const;
  bool has_tip_spring() const;
  void add_node_load(int i, Vec3d u, Vec3d force, Vector6& load) const;
  void add_spring_load(Unknowns response, Vector6 const& q, Vector6& load) const;

  Vec3d displacement(int i, Vec3d u, Vec3d force) const;            // um, of a node by flow and force per length
  Vec3d relative_motion(int i, Vector6 const& q) const;             // um, to what exerts the node's load
  void total_force(ConstPoints u, Vector6 const& q, Points f) const;  // per length on the fluid, with the motors'
  Vec3d node_force(int i, Vec3d u, Vector6 const& q, Vec3d total) const;  // of the node's load, pN/um
  Vec3d drag(int i, Vec3d velocity) const;                 // (1/c) (I - t t / 2) velocity
  Vec3d applied(int i) const;                              // external force and motors, pN/um
  // Change of the predicted points of the fiber by the body's motion, um.
  struct Carried {
    Vec3d shift, turn;
    Vec3d at(Vec3d point) const { return shift + cross(turn, point); }
  };
  Carried carried(Vector6 const& q) const;
  Vector6 predicted_motion() const;
  void add_body_load(Vec3d point, Vec3d force, Vector6& load) const;
  void respond(Eigen::Ref<Eigen::VectorXd const> reduced, Points f) const;
  Unknowns unknowns(ConstPoints u, Vector6 const& q) const;
  Vec3d tip_position(ConstPoints u, Vector6 const& q) const;  // um, at the new time level

  FiberStep step_;
  double length_ = 0.0, rate_ = 0.0;  // um; a0 / dt, 1/s
  int n_unknown_ = 0, first_rotation_ = 0, first_turn_ = 0;
  Vec3d minus_end_, plus_end_;                           // um, predicted
  PointArray nodes_, tangents_, velocity_;               // [n_node] predicted: um, -, um/s
  Eigen::VectorXd weights_;                              // [n_node] um
  PointArray directions_;                                // [n_tangent, 2] normal to the predicted tangents, parallel
  Eigen::Matrix<double, 3, Eigen::Dynamic> tip_motion_;  // [3, n_unknown] motion of the plus end
  Eigen::MatrixXd lower_;                                // [n_unknown, n_unknown]
  // lower^-1 (drag of the motions [n_unknown, 3 n_node] | forcing [n_unknown] | body columns [n_unknown, 6])
  Eigen::MatrixXd reduced_;
  Matrix6 body_resistance_ = Matrix6::Zero();
  Eigen::Matrix<double, 6, Eigen::Dynamic> load_of_flow_;  // D [6, 3 n_node]
};

}  // namespace asterflow

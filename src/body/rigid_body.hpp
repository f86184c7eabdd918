#pragma once
// Motion of one rigid body in time:  dx/dt = U,  dR/dt = [Omega x] R,  orientation a unit quaternion.
// Implicit second-order steps (BDF2 with variable step; backward Euler without history):
//   centre       x_new = (a1 x_now + a2 x_before + dt U) / a0
//   orientation  R_new = exp([phi x]) R_now,  phi = (a2 phi_before + dt Omega) / a0,
// where phi_before is the rotation vector from now back to the state before. A step in trial leaves the state alone.

#include "base/rigid.hpp"
#include "body/body_spec.hpp"

#include <Eigen/Geometry>

namespace asterflow {

class RigidBody {
 public:
  explicit RigidBody(BodySpec const& spec);

  BodySpec const& spec() const { return spec_; }
  bool is_free() const { return spec_.motion == BodySpec::Motion::free; }
  RigidPose pose() const { return now_.pose(); }
  Eigen::Quaterniond const& orientation() const { return now_.orientation; }
  Vector6 const& motion() const { return motion_; }  // velocity (um/s), angular velocity (1/s) of the last step

  Vector6 external_load() const;      // pN, pN um, of a free body
  Vector6 prescribed_motion() const;  // of a body that is not free
  void set_external_load(Vec3d force, Vec3d torque);

  // Begins a step of dt seconds: where the body will be as a function of its motion at the new time.
  BodyMotionMap const& predict(double dt);
  BodyMotionMap const& motion_map() const { return map_; }

  // Completes the trial step with the motion at the new time; accept() makes it the state.
  void advance(Vector6 const& motion);
  RigidPose trial_pose() const { return trial_.pose(); }
  double error_estimate(double arm) const;  // um, of a point at that distance (um) from the centre; 0 in a first step
  void accept();

  // Everything that a restart needs, as plain numbers.
  static constexpr int n_state = 2 * 7 + 2 * 6 + 2;
  Eigen::Matrix<double, n_state, 1> state() const;
  void set_state(Eigen::Matrix<double, n_state, 1> const& state);

 private:
  struct Configuration {
    Vec3d position;
    Eigen::Quaterniond orientation{1, 0, 0, 0};
    RigidPose pose() const { return {position, orientation.toRotationMatrix()}; }
  };

  BodySpec spec_;
  Configuration now_, before_, trial_;
  double dt_before_ = 0.0;  // s, between before and now; 0: no history
  int n_step_ = 0;          // accepted steps, at most 2
  Vector6 motion_ = Vector6::Zero(), motion_before_ = Vector6::Zero(), trial_motion_ = Vector6::Zero();
  BodyMotionMap map_;
  double dt_ = 0.0;
  Eigen::Vector3d predicted_turn_ = Eigen::Vector3d::Zero();  // phi for the predicted angular velocity
};

}  // namespace asterflow

#include "body/rigid_body.hpp"

#include "base/time_scheme.hpp"

#include <cmath>

namespace asterflow {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

Quaterniond exponential(Vector3d const& turn) {
  double const angle = turn.norm();
  return angle > 0 ? Quaterniond(AngleAxisd(angle, turn / angle)) : Quaterniond::Identity();
}

Vector3d logarithm(Quaterniond q) {
  if (q.w() < 0) q.coeffs() *= -1;
  double const sine = q.vec().norm();
  return sine > 0 ? Vector3d(2 * std::atan2(sine, q.w()) / sine * q.vec()) : Vector3d::Zero();
}

// J with exp([(phi + d) x]) = exp([J d x]) exp([phi x]) to first order in d.
Matrix3 left_jacobian(Vector3d const& phi) {
  double const angle = phi.norm();
  Matrix3 const x = cross_matrix(to_vec3(phi));
  if (angle < 1e-4) return Matrix3::Identity() + x / 2 + x * x / 6;
  return Matrix3::Identity() + (1 - std::cos(angle)) / (angle * angle) * x +
         (angle - std::sin(angle)) / (angle * angle * angle) * x * x;
}

Vector6 stacked(Vec3d linear, Vec3d angular) {
  Vector6 v;
  v << to_eigen(linear), to_eigen(angular);
  return v;
}

}  // namespace

RigidBody::RigidBody(BodySpec const& spec) : spec_(spec) {
  now_ = {spec.position, spec.orientation.normalized()};
  before_ = trial_ = now_;
  if (!is_free()) motion_ = prescribed_motion();
}

Vector6 RigidBody::external_load() const { return stacked(spec_.force, spec_.torque); }
Vector6 RigidBody::prescribed_motion() const { return stacked(spec_.velocity, spec_.angular_velocity); }

void RigidBody::set_external_load(Vec3d force, Vec3d torque) {
  spec_.force = force;
  spec_.torque = torque;
}

BodyMotionMap const& RigidBody::predict(double dt) {
  dt_ = dt;
  TimeScheme const scheme = n_step_ > 0 ? second_order_scheme(dt, dt_before_) : backward_euler(dt);
  Vector6 predicted = motion_;
  if (n_step_ > 1) predicted += dt / dt_before_ * (motion_ - motion_before_);
  if (!is_free()) predicted = prescribed_motion();

  Vector3d const centre =
      (scheme.a1 * to_eigen(now_.position) + scheme.a2 * to_eigen(before_.position) + dt * predicted.head<3>()) /
      scheme.a0;
  Vector3d const turn_before = logarithm(before_.orientation * now_.orientation.conjugate());
  predicted_turn_ = (scheme.a2 * turn_before + dt * predicted.tail<3>()) / scheme.a0;

  map_.now = now_.pose();
  map_.predicted = {to_vec3(centre), (exponential(predicted_turn_) * now_.orientation).toRotationMatrix()};
  map_.predicted_velocity = to_vec3(predicted.head<3>());
  map_.predicted_angular_velocity = to_vec3(predicted.tail<3>());
  map_.displacement_per_velocity = dt / scheme.a0;
  map_.turn_per_angular_velocity = dt / scheme.a0 * left_jacobian(predicted_turn_);
  return map_;
}

void RigidBody::advance(Vector6 const& motion) {
  double const factor = map_.displacement_per_velocity;
  Vector3d const change = motion.head<3>() - to_eigen(map_.predicted_velocity);
  Vector3d const turn = predicted_turn_ + factor * (motion.tail<3>() - to_eigen(map_.predicted_angular_velocity));
  trial_.position = map_.predicted.position + factor * to_vec3(change);
  trial_.orientation = (exponential(turn) * now_.orientation).normalized();
  trial_motion_ = motion;
}

// The corrector moves by dt / a0 (U - U extrapolated) against the predictor; a third of that is the local error of BDF2.
double RigidBody::error_estimate(double arm) const {
  if (n_step_ < 2 || !is_free()) return 0.0;
  double const factor = map_.displacement_per_velocity / 3;
  return factor * ((trial_motion_.head<3>() - to_eigen(map_.predicted_velocity)).norm() +
                   arm * (trial_motion_.tail<3>() - to_eigen(map_.predicted_angular_velocity)).norm());
}

void RigidBody::accept() {
  before_ = now_;
  now_ = trial_;
  dt_before_ = dt_;
  motion_before_ = motion_;
  motion_ = trial_motion_;
  n_step_ = std::min(n_step_ + 1, 2);
}

Eigen::Matrix<double, RigidBody::n_state, 1> RigidBody::state() const {
  Eigen::Matrix<double, n_state, 1> s;
  s << to_eigen(now_.position), now_.orientation.coeffs(), to_eigen(before_.position), before_.orientation.coeffs(),
      motion_, motion_before_, dt_before_, double(n_step_);
  return s;
}

void RigidBody::set_state(Eigen::Matrix<double, n_state, 1> const& s) {
  now_ = {to_vec3(s.segment<3>(0)), Quaterniond(Eigen::Vector4d(s.segment<4>(3)))};
  before_ = {to_vec3(s.segment<3>(7)), Quaterniond(Eigen::Vector4d(s.segment<4>(10)))};
  motion_ = s.segment<6>(14);
  motion_before_ = s.segment<6>(20);
  dt_before_ = s[26];
  n_step_ = static_cast<int>(s[27]);
  trial_ = now_;
}

}  // namespace asterflow

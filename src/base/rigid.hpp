#pragma once
// Quantities of rigid bodies: six-vectors stack a linear part on an angular part
// (velocity and angular velocity, force and torque about the body's centre).

#include "base/vec3.hpp"

#include <Eigen/Core>

namespace asterflow {

using Matrix3 = Eigen::Matrix<double, 3, 3>;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

inline Eigen::Vector3d to_eigen(Vec3d a) { return {a.x, a.y, a.z}; }
inline Vec3d to_vec3(Eigen::Vector3d const& a) { return {a[0], a[1], a[2]}; }
inline Vec3d operator*(Matrix3 const& m, Vec3d a) { return to_vec3(m * to_eigen(a)); }

// cross_matrix(a) b = a x b
inline Matrix3 cross_matrix(Vec3d a) {
  Matrix3 m;
  m << 0, -a.z, a.y, a.z, 0, -a.x, -a.y, a.x, 0;
  return m;
}

// U + Omega x r of a motion (U, Omega), at r from the centre.
inline Vec3d velocity_of_motion(Vector6 const& motion, Vec3d from_centre) {
  return to_vec3(motion.head<3>()) + cross(to_vec3(motion.tail<3>()), from_centre);
}

// Force and torque about the centre, of a force at r from the centre.
inline Vector6 load_of_force(Vec3d force, Vec3d from_centre) {
  return (Vector6() << to_eigen(force), to_eigen(cross(from_centre, force))).finished();
}

// Where a body is: position of its centre (um) and rotation from the body frame to space.
struct RigidPose {
  Vec3d position;
  Matrix3 rotation = Matrix3::Identity();
  Vec3d point(Vec3d in_body_frame) const { return position + rotation * in_body_frame; }
};

// How the pose of a body at the end of the step depends on its velocity U and angular velocity Omega there:
//   centre_new   = predicted.position + displacement_per_velocity (U - predicted_velocity)
//   rotation_new = (I + [phi x]) predicted.rotation,   phi = turn_per_angular_velocity (Omega - predicted_angular_velocity)
// For dx/dt = (a0 x_new - ...) / dt the two factors are dt / a0 (the second one to the order of the rotation in a step).
struct BodyMotionMap {
  RigidPose now{};        // at the beginning of the step
  RigidPose predicted{};  // at its end, for the predicted velocities
  Vec3d predicted_velocity{}, predicted_angular_velocity{};     // um/s, 1/s
  double displacement_per_velocity = 0.0;                       // s
  Matrix3 turn_per_angular_velocity = Matrix3::Zero();          // s

  Vector6 predicted_motion() const {
    return (Vector6() << to_eigen(predicted_velocity), to_eigen(predicted_angular_velocity)).finished();
  }
  // Displacement (um) from the prediction, by the motion q, of what moves with the body at a point, to first order.
  Vec3d displacement(Vector6 const& q, Vec3d point) const {
    Vector6 const change = q - predicted_motion();
    return displacement_per_velocity * to_vec3(change.head<3>()) +
           cross(turn_per_angular_velocity * to_vec3(change.tail<3>()), point - predicted.position);
  }
  // Its derivative with q, for a point at `arm` from the centre.
  Eigen::Matrix<double, 3, 6> displacement_of(Vec3d arm) const {
    Eigen::Matrix<double, 3, 6> moved;
    moved << displacement_per_velocity * Matrix3::Identity(), -cross_matrix(arm) * turn_per_angular_velocity;
    return moved;
  }
  // Resistance that a spring (pN/um) adds which holds a point of the body at `arm` from its centre.
  Matrix6 spring_resistance(Vec3d arm, Matrix3 const& stiffness) const {
    Eigen::Matrix<double, 3, 6> lever;  // velocity of the point per motion
    lever << Matrix3::Identity(), -cross_matrix(arm);
    return lever.transpose() * stiffness * displacement_of(arm);
  }
};

}  // namespace asterflow

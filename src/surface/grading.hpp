#pragma once
// Parametrisation of the unit sphere by grid angles (t, phi) with nodes crowded around one pole:
//   d(t, phi) = cos theta(t) e_1 + sin theta(t) (cos phi e_2 + sin phi e_3),  (e_1, e_2, e_3) right-handed,
//   d theta / d t  proportional to  (width^2 / 4 + sin^2(theta / 2))^(1/2),
// a smooth odd map of [0, pi] onto itself: spacing is uniform in log theta beyond theta = width. The exact solution is a
// Jacobi amplitude, theta = pi - 2 am(K (1 - t / pi), k), k^2 = 1 / (1 + width^2 / 4), so features of size `width` at
// the pole cost log(1 / width) more nodes. An infinite width is the plain sphere, theta = t.

#include "base/vec3.hpp"

#include <Eigen/Core>

namespace asterflow {

class Grading {
 public:
  // frame: columns e_1, e_2, e_3.
  explicit Grading(Eigen::Matrix3d const& frame);          // uniform
  Grading(Eigen::Matrix3d const& frame, double width);     // radians, > 0

  Eigen::Matrix3d const& frame() const { return frame_; }
  bool uniform() const { return modulus_ == 0.0; }

  struct PolarAngle {
    double theta, slope;  // slope: d theta / d t
  };
  PolarAngle polar_angle(double t) const;
  double grid_angle(double theta) const;  // t(theta)

 private:
  Eigen::Matrix3d frame_;
  double modulus_ = 0.0, quarter_period_ = 0.0;
};

// Frames: cyclic permutation that takes x to the axis 0, 1, 2; any rotation that takes x to a unit vector.
Eigen::Matrix3d axis_frame(int axis);
Eigen::Matrix3d pole_frame(Vec3d pole);

}  // namespace asterflow

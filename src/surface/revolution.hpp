#pragma once
// Surface of revolution about the x axis, star-shaped about its centre, the midpoint of its poles:
//   X = centre + R(theta) d,   R(theta) = sum_k c_k cos(k theta),   cos theta = d_x.
// c is the least-squares fit of the lowest degree that meets the profile's points to 1e-9 of its size, or of the
// highest degree that the number of points allows.

#include "surface/shapes.hpp"

#include <array>

namespace asterflow {

class Revolution : public Shape {
 public:
  // profile: points (x, r), um, from pole to pole, x ascending. Throws SceneError if they describe no such shape.
  explicit Revolution(std::vector<std::array<double, 2>> const& profile);

  bool axisymmetric() const override { return true; }
  Vec3d centre() const override { return {centre_, 0.0, 0.0}; }
  SphereImage image(Vec3d direction) const override;
  void sample(Columns const& directions, Columns& positions, Columns& areas) const override;
  ClosestPoint closest_point(Vec3d x) const override;
  ShellPoint shell_point(Vec3d x) const override;
  double size() const override { return largest_; }
  double aspect_ratio() const override { return largest_ / smallest_; }

 private:
  // Meridian relative to the centre and its derivatives with respect to theta.
  struct MeridianPoint {
    double z, r, dz, dr, ddz, ddr;
  };
  MeridianPoint meridian(double theta) const;
  std::array<double, 3> radius(double theta) const;  // R, R', R''
  double closest_angle(double z, double r) const;

  double centre_, largest_, smallest_;
  std::vector<double> coefficients_;
  std::vector<std::array<double, 2>> samples_;  // (z, r) at equispaced angles, for the first guess
};

}  // namespace asterflow

#pragma once
// Ellipsoid x^2/a^2 + y^2/b^2 + z^2/c^2 = 1 with any semi-axes; X = (a d_x, b d_y, c d_z).

#include "surface/shapes.hpp"

namespace asterflow {

class Ellipsoid : public Shape {
 public:
  explicit Ellipsoid(Vec3d semi_axes);

  bool axisymmetric() const override;
  SphereImage image(Vec3d direction) const override;
  void sample(Columns const& directions, Columns& positions, Columns& areas) const override;
  ClosestPoint closest_point(Vec3d x) const override;
  ShellPoint shell_point(Vec3d x) const override;
  double size() const override;
  double aspect_ratio() const override;

 private:
  Vec3d axes_;
};

}  // namespace asterflow

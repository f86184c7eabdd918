#include "surface/surface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace asterflow;

TEST(Grading, angles_and_their_inverse_agree_and_the_slope_is_the_derivative) {
  for (double const width : {3.0, 0.3, 0.01}) {
    Grading const grading(axis_frame(0), width);
    for (double t = 0.05; t < std::numbers::pi; t += 0.1) {
      double const step = 1e-6;
      auto const [theta, slope] = grading.polar_angle(t);
      EXPECT_NEAR(grading.grid_angle(theta), t, 1e-12);
      EXPECT_NEAR(slope, (grading.polar_angle(t + step).theta - grading.polar_angle(t - step).theta) / (2.0 * step), 1e-8 * slope + 1e-8);
    }
    EXPECT_NEAR(grading.polar_angle(0.0).theta, 0.0, 1e-14);
    EXPECT_NEAR(grading.polar_angle(std::numbers::pi).theta, std::numbers::pi, 1e-14);
  }
}

TEST(Grading, crowded_nodes_still_integrate_the_area) {
  ShapeSpec const spec{.radius = 2.0};
  Surface const surface(make_shape(spec), 30, Grading(pole_frame(normalized(Vec3d{1, 2, -2})), 0.2));
  EXPECT_NEAR(surface.area() / (16.0 * std::numbers::pi), 1.0, 1e-10);
  double nearest = 4.0;
  for (Vec3d const x : surface.nodes()) nearest = std::min(nearest, norm(x - 2.0 * normalized(Vec3d{1, 2, -2})));
  EXPECT_LT(nearest, 0.05);  // an even grid of this order has its first ring at 0.15
}

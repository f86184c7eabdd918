#include "surface/contact.hpp"
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

// A sphere laid on an ellipsoid from outside and from inside, apart or overlapping a little.
TEST(Contact, gap_of_a_sphere_and_an_ellipsoid_is_exact) {
  auto const ellipsoid = make_shape({.kind = ShapeSpec::Kind::ellipsoid, .semi_axes = {3.0, 2.0, 1.5}});
  double const radius = 0.7;
  for (double const gap : {0.02, 1e-3, 1e-5, -1e-5, -1e-3})
    for (Vec3d const x : {Vec3d{1, 2, -2}, Vec3d{-3, 0.3, 1}, Vec3d{0, 0, 1}})
      for (bool const inside : {false, true}) {
        ClosestPoint const at = ellipsoid->closest_point(x);
        Vec3d const centre = at.position + (inside ? -1.0 : 1.0) * (radius + gap) * at.normal;
        PlacedSurface const ball{make_shape({.radius = radius}), centre}, around{.shape = ellipsoid, .encloses = inside};
        for (Contact const& contact : {find_contact(ball, around), find_contact(around, ball)}) {
          EXPECT_NEAR(contact.gap, gap, 1e-9) << inside;
          EXPECT_NEAR(norm(contact.first - contact.second), std::abs(gap), 1e-9);
        }
      }
}

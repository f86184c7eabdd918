#include "surface/shapes.hpp"

#include "base/error.hpp"
#include "base/random.hpp"
#include "surface/surface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace asterflow;

namespace {

ShapeSpec ellipsoid(double a, double b, double c) {
  return {.kind = ShapeSpec::Kind::ellipsoid, .semi_axes = {a, b, c}};
}

ShapeSpec sphere(double radius) {
  return {.radius = radius};
}



// An egg: R = 10 + 3 cos(theta) + cos(2 theta) about its centre, n points.
ShapeSpec egg(int n) {
  ShapeSpec spec;
  spec.kind = ShapeSpec::Kind::revolution;
  for (int i = 0; i < n; ++i) {
    double const theta = std::numbers::pi * (n - 1 - i) / (n - 1), radius = 10.0 + 3.0 * std::cos(theta) + std::cos(2.0 * theta);
    spec.profile.push_back({radius * std::cos(theta), std::abs(radius * std::sin(theta))});
  }
  spec.profile.front()[1] = spec.profile.back()[1] = 0.0;
  return spec;
}

// The meridian of the ellipsoid a x b x b as a profile.
ShapeSpec elliptic_profile(double a, double b, int n) {
  ShapeSpec spec;
  spec.kind = ShapeSpec::Kind::revolution;
  for (int i = 0; i < n; ++i) {
    double const t = std::numbers::pi * (n - 1 - i) / (n - 1);
    spec.profile.push_back({a * std::cos(t), i == 0 || i == n - 1 ? 0.0 : b * std::sin(t)});
  }
  return spec;
}

Vec3d random_vector(int i) {
  return {uniform_random(1, i, 0, 0) - 0.5, uniform_random(1, i, 0, 1) - 0.5, uniform_random(1, i, 0, 2) - 0.5};
}

std::vector<ShapeSpec> all_shapes() {
  return {sphere(5.0), ellipsoid(25, 15, 15), ellipsoid(1, 2, 2), ellipsoid(3, 3, 1), ellipsoid(1, 2, 3), egg(30)};
}

}  // namespace

TEST(Shapes, closest_point_lies_on_the_surface_along_its_normal) {
  for (auto const& spec : all_shapes()) {
    auto const shape = make_shape(spec);
    for (int i = 0; i < 200; ++i) {
      Vec3d const x = 4.0 * shape->size() * uniform_random(1, i, 0, 3) * random_vector(i);
      ClosestPoint const c = shape->closest_point(x);
      double const tolerance = 1e-12 * shape->size();
      EXPECT_LT(norm(x - c.position - c.distance * c.normal), tolerance);
      EXPECT_LT(norm(shape->image(c.direction).position - c.position), tolerance);
      EXPECT_NEAR(shape->shell_point(c.position).rho, 1.0, 1e-12);
      EXPECT_EQ(c.distance < 0.0, shape->shell_point(x).rho < 1.0);
    }
  }
}

TEST(Shapes, no_surface_node_is_closer_than_the_closest_point) {
  for (auto const& spec : all_shapes()) {
    Surface const surface(make_shape(spec), 20);
    for (int i = 0; i < 50; ++i) {
      Vec3d const x = 3.0 * surface.shape().size() * random_vector(i);
      double const distance = std::abs(surface.shape().signed_distance(x));
      for (Vec3d const y : surface.nodes()) EXPECT_GE(norm(x - y), distance * (1.0 - 1e-12));
    }
  }
}

TEST(Shapes, signed_distance_keeps_its_relative_accuracy_at_the_surface) {
  auto const shape = make_shape(ellipsoid(25, 15, 15));
  for (double const offset : {1e-3, 1e-6, 1e-9}) {
    ClosestPoint const on = shape->closest_point({20, 9, 5});
    Vec3d const x = on.position - offset * on.normal;
    EXPECT_NEAR(shape->signed_distance(x), -offset, 1e-13);
  }
}

TEST(Shapes, closest_point_exists_on_the_medial_set) {
  auto const shape = make_shape(ellipsoid(25, 15, 15));
  EXPECT_NEAR(shape->signed_distance({0, 0, 0}), -15.0, 1e-12);
  EXPECT_NEAR(shape->signed_distance({5, 0, 0}), -15.0 * std::sqrt(1.0 - 25.0 / (625.0 - 225.0)), 1e-12);
  EXPECT_NEAR(shape->signed_distance({24, 0, 0}), -1.0, 1e-12);
  EXPECT_NEAR(make_shape(sphere(2.0))->signed_distance({0, 0, 0}), -2.0, 1e-15);
}

TEST(Shapes, area_and_volume_of_a_spheroid_are_exact) {
  Surface const surface(make_shape(ellipsoid(25, 15, 15)), 40);
  double const e = 0.8;  // eccentricity
  double const area = 2.0 * std::numbers::pi * 225.0 * (1.0 + 25.0 / (15.0 * e) * std::asin(e));
  EXPECT_NEAR(surface.area(), area, 1e-12 * area);
  EXPECT_NEAR(surface.volume(), 4.0 / 3.0 * std::numbers::pi * 25.0 * 225.0, 1e-9);
}

TEST(Shapes, profile_of_a_spheroid_gives_the_spheroid) {
  auto const turned = make_shape(elliptic_profile(25, 15, 61)), exact = make_shape(ellipsoid(25, 15, 15));
  for (int i = 0; i < 100; ++i) {
    Vec3d const x = 40.0 * random_vector(i);
    EXPECT_NEAR(turned->signed_distance(x), exact->signed_distance(x), 1e-6);
  }
}

TEST(Shapes, profile_needs_to_be_star_shaped_about_the_midpoint_of_its_poles) {
  ShapeSpec spec = elliptic_profile(2, 1, 20);
  spec.profile[10][1] = 0.001;
  EXPECT_THROW(make_shape(spec), SceneError);
  spec.profile = {{-1.0, 0.0}, {0.0, 1.0}};
  EXPECT_THROW(make_shape(spec), SceneError);
}

TEST(Shapes, impossible_shapes_are_refused) {
  EXPECT_THROW(make_shape(sphere(-1.0)), SceneError);
  EXPECT_THROW(make_shape(ellipsoid(1, 0, 1)), SceneError);
  EXPECT_THROW(make_shape(ellipsoid(1, std::nan(""), 1)), SceneError);
}

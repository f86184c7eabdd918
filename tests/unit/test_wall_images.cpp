// Point forces close to a plane wall and to a body; close to the cortex: test_screened_forces.cpp.

#include "system/radiation.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

using namespace asterflow;

namespace {

constexpr double viscosity = 1.7;

Radiation::Flow cell(int order) {
  ShapeSpec const spec{.kind = ShapeSpec::Kind::ellipsoid, .semi_axes = {25, 15, 15}};
  return std::make_shared<DirichletFlow const>(Surface(make_shape(spec), order), Side::interior, 1e-8);
}

// A wall that is nearly plane: a sphere of radius 1e5 um, whose inside is x < 0 at the origin.
Surface plane() {
  ShapeSpec const spec{.radius = 1e5};
  return Surface(make_shape(spec), 8);
}
Vec3d const origin{1e5, 0, 0};

}  // namespace

TEST(WallImages, keep_a_plane_wall_at_rest) {
  PointArray const source{origin + Vec3d{-0.3, 0.1, 0.2}}, strength{{0.4, -0.7, 0.9}};
  Surface const wall = plane();
  WallImages images(ImageWall(wall, Side::interior, false));
  images.place({}, source, std::vector{0.1}, {0, 1});
  for (double const r : {0.0, 0.1, 1.0, 10.0}) {
    PointArray const target{origin + Vec3d{-0.5e-5 * r * r, r, 0.3 * r}};
    PointArray u(1);
    images.add_velocity<double>(strength, target, u);
    Vec3d const d = target[0] - source[0];
    double const distance = norm(d);
    Vec3d const direct = 1.0 / (8 * M_PI) * (1 / distance * strength[0] + dot(d, strength[0]) / std::pow(distance, 3) * d);
    EXPECT_LT(norm(u[0] + direct), 1e-4 * norm(direct)) << r;  // r^2 / R over d
  }
}

TEST(WallImages, of_a_fiber_act_on_it_from_no_closer_than_it_is_resolved) {
  PointArray const near{origin + Vec3d{-0.01, 0, 0}}, far{origin + Vec3d{-0.2, 0, 0}}, strength{{0.4, -0.7, 0.9}};
  Surface const surface = plane();
  ImageWall const wall(surface, Side::interior, false);
  WallImages close(wall), resolved(wall);
  close.place({}, near, std::vector{0.4}, {0, 1});
  resolved.place({}, far, std::vector{0.4}, {0, 1});
  PointArray felt(1), expected(1);
  close.add_velocity<double>(strength, near, felt);
  close.add_own_resolution(strength, near, felt);
  resolved.add_velocity<double>(strength, near, expected);
  EXPECT_LT(norm(felt[0] - expected[0]), 1e-6 * norm(expected[0]));
}

TEST(WallImages, merge_for_a_rough_flow_far_from_the_origin) {
  ShapeSpec const spec{.radius = 300};
  Surface const wall(make_shape(spec), 8);  // nodes 100 um apart
  WallImages images(ImageWall(wall, Side::interior, false));
  RigidPose pose;
  pose.position = {7e5, -3e5, 1e5};
  Vec3d const at_wall = pose.position + Vec3d{300, 0, 0};
  PointArray positions, strengths, targets;
  for (int i = 0; i < 32; ++i) {
    positions.push_back(at_wall + Vec3d{-0.2 - 0.25 * i, 0.1 * i, 0});
    strengths.push_back({0.3 + 0.02 * i, 1.0 - 0.001 * i * i, std::sin(0.1 * i)});
  }
  for (double const z : {0.5, 1.0, 2.0, 5.0, 20.0}) targets.push_back(at_wall + Vec3d{-z, 0.1, 0.7 * z});
  images.place(pose, positions, std::vector(32, 0.25), {0, 32});
  PointArray exact(targets.size()), rough(targets.size());
  images.add_velocity<double>(strengths, targets, exact);
  images.add_rough_velocity(strengths, targets, rough);
  for (std::size_t i = 0; i < targets.size(); ++i) {
    EXPECT_LT(norm(rough[i] - exact[i]), 0.02 * norm(exact[i])) << i;
    EXPECT_GT(norm(rough[i] - exact[i]), 1e-5 * norm(exact[i])) << i;  // fewer images
  }
}

TEST(WallImages, are_not_made_of_distant_forces) {
  auto const flow = cell(20);
  WallImages images(ImageWall(flow->surface(), Side::interior, false));
  images.place({}, PointArray{{0, 0, 0}, {5, 0, 0}}, std::vector{1.0, 1.0}, {0, 2});
  EXPECT_EQ(images.size(), 0u);  // nodes of the cell are 4 um apart
}

TEST(WallImages, stay_within_a_thin_body) {
  ShapeSpec const spec{.kind = ShapeSpec::Kind::ellipsoid, .semi_axes = {3, 0.3, 0.3}};
  Surface const rod(make_shape(spec), 6);  // nodes 1.6 um apart
  WallImages images(ImageWall(rod, Side::exterior, false));
  images.place({}, PointArray{{0, 1.0, 0}, {0, 0.4, 0}}, std::vector{0.1, 0.1}, {0, 2});
  EXPECT_EQ(images.size(), 1u);  // of the force at 0.1 um: that of the one at 0.7 um would lie beyond the rod
}

namespace {

constexpr double radius = 5.0;
RigidPose const pose{{2, -1, 3}, Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix()};

struct HeldBall {
  Vector6 load;    // pN, pN um
  Vec3d velocity;  // um/s at x
};

// What the force f at y does to a ball that is held, and to the fluid at x.
HeldBall answer_of_ball(Vec3d x, Vec3d y, Vec3d f) {
  ShapeSpec const spec{.radius = radius};
  static auto const ball = std::make_shared<DirichletFlow const>(Surface(make_shape(spec), 16), Side::exterior, 1e-8);
  Radiation radiation({ball}, nullptr, {.viscosity = viscosity, .evaluator = "direct", .accuracy = 1e-12});
  PointArray const source{y}, density{f}, target{x};
  std::vector<double> const weights{1.0};
  std::vector<std::size_t> const first{0, 1};
  std::vector<Vector6> const still{Vector6::Zero()};
  radiation.set_geometry({source, weights, &first}, {pose});
  PointArray received(radiation.nodes().size()), nothing(radiation.nodes().size()), u(1);
  radiation.exchange(density, still, {false}, nothing, received);
  radiation.add_velocity(density, still, received, target, u);
  return {radiation.load_of_incident(0, received), u[0]};
}

}  // namespace

// Reciprocal theorem with the flow of a moving and of a turning sphere: F = f . [3 a/4 (1/r + rr/r^3) + a^3/4 (1/r^3 - 3 rr/r^5)],
// T = (a/r)^3 r x f.
TEST(WallImages, show_a_body_the_load_of_a_force_at_any_distance) {
  double const a = radius;
  for (double const distance : {0.02, 0.2, 1.0, 5.0})
    for (Vec3d const f : {Vec3d{1, 2, -0.5}, Vec3d{-0.3, 1, 1}}) {
      double const r = a + distance;
      Vec3d const n = normalized(Vec3d{0.3, -0.5, 0.8});
      Vec3d const force = (0.75 * a / r) * (f + dot(n, f) * n) + (0.25 * std::pow(a / r, 3)) * (f - 3 * dot(n, f) * n);
      Vec3d const torque = std::pow(a / r, 3) * r * cross(n, f);
      Vector6 const load = answer_of_ball({20, 0, 0}, pose.position + r * n, f).load;
      // What curvature leaves to nodes that are 1 um apart; 0.2 to 0.5 without images.
      EXPECT_LT(norm(to_vec3(load.head<3>()) - force), 3e-3 * norm(f)) << distance;
      EXPECT_LT(norm(to_vec3(load.tail<3>()) - torque), 3e-3 * a * norm(f)) << distance;
    }
}

TEST(WallImages, screen_forces_at_any_distance_from_a_body) {
  Vec3d const x = pose.position + Vec3d{-8, 9, 4}, n = normalized(Vec3d{0.3, -0.5, 0.8}), f{1, 2, -0.5};
  for (double const distance : {0.02, 0.2, 1.0}) {
    Vec3d const y = pose.position + (radius + distance) * n, u = answer_of_ball(x, y, f).velocity;
    for (int k = 0; k < 3; ++k) {
      Vec3d g;
      g[k] = 1.0;
      double const error = std::abs(u[k] - dot(f, answer_of_ball(y, x, g).velocity));
      EXPECT_LT(error * 8 * M_PI * viscosity * norm(x - y), 3e-3 * norm(f)) << distance;
    }
  }
}

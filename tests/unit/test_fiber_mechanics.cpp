// Exact answers of the mechanics of one fiber.
#include "fiber_fixture.hpp"

#include <gtest/gtest.h>

using namespace asterflow;
using namespace asterflow::test;

namespace {

constexpr double pi = std::numbers::pi;

// Does a nearly straight fiber along x, pressed at its plus end by `force` (pN), bend further after its fast modes have
// died out? `holds_tip`: the plus end may move along x only.
bool buckles(MinusEnd minus_end, bool holds_tip, double force) {
  double const length = 7.0, rigidity = 3.0, viscosity = 0.4;
  FiberProperties properties{.bending_rigidity = rigidity, .n_node = 16};
  properties.tip.force = {-force, 0, 0};
  Centreline const shape =
      bent_centreline(length, 16, 1e-6, [](double a) { return a * (1 - a) + 0.3 * a * a * a - 0.05; });
  if (holds_tip) {
    properties.tip.stiffness(1, 1) = properties.tip.stiffness(2, 2) = 1e5;
    properties.tip.anchor = {length, 0, 0};
  }
  Fibers fibers(viscosity);
  fibers.add(properties, {.kind = minus_end}, shape);
  double const slowest = slender_body_mobility(length, 0.0125, viscosity) * rigidity * std::pow(1.8 / length, 4);
  double before = 0.0;
  for (int i = 0; i < 60; ++i) {
    before = fibers.elastic_energy();
    fibers.begin_step();
    step(fibers, 0.1 / slowest);
  }
  return fibers.elastic_energy() > before;
}

void expect_buckling_load(MinusEnd minus_end, bool holds_tip, double load_in_rigidity_over_square_length) {
  double const load = load_in_rigidity_over_square_length * 3.0 / (7.0 * 7.0);
  EXPECT_FALSE(buckles(minus_end, holds_tip, 0.999 * load));
  EXPECT_TRUE(buckles(minus_end, holds_tip, 1.001 * load));
}

}  // namespace

TEST(FiberMechanics, clamped_free_fiber_buckles_at_Eulers_load) {
  expect_buckling_load(MinusEnd::clamped, false, pi * pi / 4);
}

TEST(FiberMechanics, hinged_hinged_fiber_buckles_at_Eulers_load) {
  expect_buckling_load(MinusEnd::hinged, true, pi * pi);
}

TEST(FiberMechanics, clamped_hinged_fiber_buckles_at_Eulers_load) {
  expect_buckling_load(MinusEnd::clamped, true, 20.190728556426629);
}

// A fiber aligned with the compressing axis of the flow (-x, y, 0) rate / 2, as in the shear flow of that rate at 45
// degrees.
TEST(FiberMechanics, fiber_in_shear_buckles_at_306) {
  double const length = 6.0, rigidity = 5.0, viscosity = 2.0;
  double const scale = rigidity * slender_body_mobility(length, 0.0125, viscosity) / std::pow(length, 4);
  auto const bends_further = [&](double number) {  // 8 pi mu G L^4 / (E ln(1/(e eps^2)))
    double const half_rate = 0.5 * number * scale;
    Fibers fibers(viscosity);
    Centreline shape = bent_centreline(length, 24, 1e-6, [](double a) { return std::cos(pi * a); });
    shape.minus_end = {-length / 2, 0, 0};
    fibers.add({.bending_rigidity = rigidity, .n_node = 24}, {}, shape);
    double before = 0.0;
    for (int i = 0; i < 100; ++i) {
      before = fibers.elastic_energy();
      fibers.begin_step();
      step(fibers, 0.05 / half_rate, [&](Vec3d x) { return half_rate * Vec3d{-x.x, x.y, 0}; });
    }
    return fibers.elastic_energy() > before;
  };
  EXPECT_FALSE(bends_further(0.98 * 306.4));
  EXPECT_TRUE(bends_further(1.02 * 306.4));
}

// A centreline has no thickness: Jeffery's orbit in its slender limit, a line element of the fluid.
TEST(FiberMechanics, stiff_fiber_in_shear_turns_as_Jeffery_says) {
  double const shear_rate = 1.5, dt = 0.005;
  auto const flow = [&](Vec3d x) { return Vec3d{shear_rate * x.y, 0, 0}; };
  Fibers fibers(0.3);
  Vec3d const start = normalized(Vec3d{-1, 0.5, 0.4});
  fibers.add({.bending_rigidity = 1e3, .n_node = 12}, {}, straight_centreline({}, start, 2.0, 12));
  for (int i = 0; i < 400; ++i) {
    fibers.begin_step();
    step(fibers, dt, flow);
  }
  double const time = 400 * dt;
  Vec3d const exact = normalized(start + Vec3d{shear_rate * time * start.y, 0, 0});
  EXPECT_LT(norm(fibers.shape(0).tangents[0] - exact), 2e-4);  // dt^2 G^2 / 3 per unit of G t
}

TEST(FiberMechanics, body_feels_the_force_and_the_bending_moment_at_the_minus_end) {
  double const rigidity = 2.0;
  Fibers fibers(1.0);
  Vec3d const site{1.0, -2.0, 0.5}, direction = normalized(Vec3d{1, 1, 0});
  fibers.add({.bending_rigidity = rigidity, .tip = {.force = {0.1, 0.3, -0.2}}, .n_node = 48},
             {.kind = MinusEnd::clamped, .body = 0, .position = site, .direction = direction},
             straight_centreline(site, direction, 5.0, 48));
  double const dt = 0.02;
  BodyMotionMap const body{.displacement_per_velocity = dt, .turn_per_angular_velocity = dt * Matrix3::Identity()};
  RigidPose const pose;
  Vector6 const rest = Vector6::Zero();
  Vector6 load;
  double tension = 0.0;
  for (int i = 0; i < 2000; ++i) {  // until nothing moves
    fibers.begin_step();
    fibers.prepare(dt, {&body, 1});
    PointArray u, f(fibers.node_count());
    for (Vec3d x : fibers.nodes()) u.push_back({0.05 * x.y, 0.1, 0.02 * x.x});
    load.setZero();
    fibers.add_affine_response(f, {&load, 1});
    fibers.add_linear_response(u, {&rest, 1}, f, {&load, 1});
    fibers.advance(u, {&rest, 1}, {&pose, 1});
    fibers.accept();
    tension = fibers.tension(0)[0];
  }
  Centreline const& shape = fibers.shape(0);
  double const s[2] = {0.0, 1e-4};
  PointArray t(2);
  sample(shape, s, {}, t);
  Vec3d const moment = rigidity * cross(t[0], (t[1] - t[0]) / 1e-4), force = to_vec3(load.head<3>());
  Vec3d const torque = to_vec3(load.tail<3>()) - cross(site, force);
  EXPECT_LT(norm(torque - moment), 1e-4 * norm(moment));  // of the finite difference
  EXPECT_NEAR(dot(force, t[0]) - dot(moment, moment) / rigidity, tension, 0.01 * std::abs(tension));  // near s = 0
}

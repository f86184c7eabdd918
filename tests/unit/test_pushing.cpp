#include "mechanism/pushing.hpp"

#include "system/simulation.hpp"
#include "time_order.hpp"

#include <gtest/gtest.h>

using namespace asterflow;

namespace {

std::shared_ptr<Shape const> sphere(double radius) {
  ShapeSpec const spec{.radius = radius};
  return make_shape(spec);
}

Pushing pushing_of(PushingSpec const& spec) {
  Pushing pushing(spec, CortexSurface(sphere(5.0), 0.1));
  pushing.add_tip(40.0);
  pushing.begin_step();
  return pushing;
}

Matrix3 compliance() {
  Matrix3 c;
  c << 0.04, 0.01, 0.0, 0.01, 0.03, 0.005, 0.0, 0.005, 0.02;
  return c;
}

// One fiber held in space grows against the wall of a spherical cell, without chance.
std::string growing_scene(std::string const& pushing, std::string const& place, double length = 3.0) {
  return R"(
    [fluid]
    viscosity = 0.7
    [periphery]
    shape = "sphere"
    radius = 4.0
    [[fiber]]
    minus_end = "clamped"
    growing = true
    nodes = 12
    )" + place + "\nlength = " + std::to_string(length) + R"(
    [dynamic_instability]
    catastrophe_rate = 0.0
    [pushing]
    minimal_catastrophe_rate = 0.0
  )" + pushing + R"(
    [run]
    interactions = "local"
    accuracy = 1e-4
  )";
}

std::unique_ptr<Simulation> simulated(std::string const& scene, double end) {
  auto simulation = std::make_unique<Simulation>(parse_scene(scene, "test.toml"));
  while (simulation->time() < end) simulation->step(end);
  return simulation;
}

std::string const radial = "direction = [0, 0, 1]", oblique = "position = [-0.7, 0, 0]\ndirection = [0.5, 0.2, 0.8]";
std::string const no_sliding = "sliding = \"none\"\nspring_stiffness = 30.0\n";
std::string const free_sliding = "sliding = \"free\"\n";

}  // namespace

TEST(Pushing, spring_without_sliding_balances_the_compliance) {
  Pushing pushing = pushing_of({});
  Vec3d const anchor{0, 0, 5.0 - 0.1 - 0.01}, free_position{0.05, 0.02, 4.95};  // wherever within d* contact began
  pushing.make_contact(0, anchor, 0.1);
  TipLoad const load = pushing.load(0, free_position, compliance(), {0, 0, 1}, 0.1);
  Vec3d const force = balanced_force(load, free_position, compliance());
  Vec3d const position = free_position + compliance() * force;
  Vec3d const stretch = position - anchor;  // along the normal with F_P / d* = 220 pN/um
  EXPECT_LT(norm(force + Vec3d{40.0 * stretch.x, 40.0 * stretch.y, 220.0 * stretch.z}), 1e-12);
}

TEST(Pushing, free_sliding_force_obeys_its_law_at_the_balanced_position) {
  Pushing const pushing = pushing_of({.sliding = PushingSpec::Sliding::free, .stall_force = 3.0, .range = 0.03});
  Vec3d const tangent = normalized(Vec3d{0.4, 0.1, 0.8});
  for (double const overshoot : {-0.3, 0.0, 0.2}) {
    Vec3d const free_position{0.1, -0.2, 4.9 + overshoot};
    TipLoad const load = pushing.load(0, free_position, compliance(), tangent, 0.1);
    Vec3d const force = balanced_force(load, free_position, compliance());
    Vec3d const position = free_position + compliance() * force, n = normalized(position);
    double const distance = 5.0 - 0.1 - norm(position);
    double const law = 3.0 * std::exp(-distance / 0.03) * dot(n, tangent);
    EXPECT_LT(norm(force + law * n), 1e-5 * law) << overshoot;  // the normal turns a little with the position
    double const slope = dot(n, load.stiffness * n);
    EXPECT_NEAR(slope, law / 0.03, 1e-4 * slope) << overshoot;
  }
  TipLoad const inwards = pushing.load(0, {0, 0, 4.89}, compliance(), {0, 0, -1}, 0.1);
  EXPECT_EQ(norm(inwards.force), 0.0);
}

TEST(Pushing, friction_lies_between_the_limits) {
  Vec3d const free_position{0.05, 0.0, 4.95};
  auto const force_with = [&](PushingSpec const& spec) {
    Pushing pushing = pushing_of(spec);
    pushing.make_contact(0, {0, 0, 5.0 - 0.1 - 0.02}, 0.1);
    return balanced_force(pushing.load(0, free_position, compliance(), {0, 0, 1}, 0.1), free_position, compliance());
  };
  using enum PushingSpec::Sliding;
  Vec3d const held = force_with({}), sticky = force_with({.sliding = friction, .friction = 1e9}),
              slippery = force_with({.sliding = friction, .friction = 1e-9}),
              between = force_with({.sliding = friction, .friction = 2.0});
  EXPECT_LT(norm(sticky - held), 1e-6);
  EXPECT_LT(std::abs(slippery.x), 1e-6);
  EXPECT_GT(std::abs(slippery.z), 0.5);
  EXPECT_GT(-between.x, 0.1 * -held.x);
  EXPECT_LT(-between.x, 0.9 * -held.x);
}

TEST(Pushing, slides_at_the_speed_of_force_over_friction) {
  // A tip that leaves the contact at v along the wall: zeta dx/dt = K (v t - x), so it leads by v tau (1 - exp(-t / tau)).
  Pushing pushing = pushing_of({.sliding = PushingSpec::Sliding::friction, .friction = 50.0});
  double const dt = 0.01, v = 0.02, tau = 50.0 / 40.0;
  auto const position = [&](double t) { return Vec3d{v * t, 0.0, 4.9}; };
  for (int i = 0; i < 100; ++i) {
    pushing.begin_step();
    if (i == 0) pushing.make_contact(0, {0, 0, 4.9}, dt);
    pushing.advance(0, true, {}, position((i + 1) * dt), {0, 0, 1}, dt);
    pushing.accept();
  }
  pushing.begin_step();
  TipLoad const load = pushing.load(0, position(1.0), Matrix3::Zero(), {0, 0, 1}, 1e-9);
  double const exact = v * tau * (1 - std::exp(-1.0 / tau));
  EXPECT_NEAR(position(1.0).x - load.anchor.x, exact, 1e-3 * exact);  // the wall is curved
}

TEST(Pushing, rates_follow_the_force) {
  Pushing pushing = pushing_of({.stall_force = 2.0, .minimal_catastrophe_rate = 0.3});
  pushing.make_contact(0, {0, 0, 4.9}, 1000.0);
  pushing.advance(0, true, {}, {0, 0, 4.9}, {0, 0, 1}, 1000.0);  // an old contact
  pushing.accept();
  TipSurroundings around;
  pushing.surround(0, 0.1, 1.0, 3.0, around);
  double const factor = std::exp(-1.5);
  EXPECT_DOUBLE_EQ(around.pushing_growth_factor, 1.5 / (std::exp(1.5) - 1));  // exact for F linear in L
  EXPECT_DOUBLE_EQ(around.pushing_catastrophe_rate, 0.5 * (0.3 + 0.1 / factor));  // Eq. 7
}

TEST(Pushing, load_that_rises_steeply_at_first_slows_growth_from_the_beginning) {
  // F = t^0.6 from contact on, small beside F_P: 1 - V_g / V_g0 is its integral over F_P, whatever the steps.
  Pushing pushing = pushing_of({.stall_force = 1e4, .minimal_catastrophe_rate = 0.3});
  double const dt = 0.25;
  double integral = 0.0;
  for (int step = 0; step < 8; ++step) {
    double const after = std::pow((step + 1) * dt, 0.6);
    TipSurroundings around;
    pushing.begin_step();
    if (step == 0) pushing.make_contact(0, {0, 0, 4.9}, dt);
    pushing.surround(0, 0.1, dt, after, around);
    integral += dt * (1 - around.pushing_growth_factor) * 1e4;
    pushing.advance(0, true, {0, 0, -after}, {0, 0, 4.9}, {0, 0, 1}, dt);
    pushing.accept();
  }
  EXPECT_NEAR(integral, std::pow(2.0, 1.6) / 1.6, 1e-3);
}

TEST(Pushing, straight_fiber_against_the_wall_grows_by_the_law_of_force_and_speed) {
  // A fiber along the normal stays straight: F = (F_P / d*) (L - L_contact), dL/dt = V exp(-F / F_P):
  // F(t) = F_P log(1 + V t / d*). Before it buckles: 20.19 E / L^2 = 14 pN.
  auto const simulation = simulated(growing_scene(no_sliding, radial), 3.0);
  double const contact = 4.0 - 0.1 - 0.02, since = 3.0 - (contact - 3.0) / 0.5;
  double const force = 4.4 * std::log(1 + 0.5 * since / 0.02);
  EXPECT_EQ(simulation->tip_state(0), TipState::pushing);
  EXPECT_NEAR(simulation->fibers().shape(0).length, contact + force * 0.02 / 4.4, 1e-3);
  EXPECT_NEAR(simulation->fibers().ends(0).plus_end.z, -force, 2e-2 * force);
  EXPECT_NEAR(simulation->fibers().ends(0).minus_end.z, -force, 2e-2 * force);
}

TEST(Pushing, compressed_fiber_of_free_sliding_stalls_in_front_of_the_wall) {
  // Growth adds length until exp(-F / F_P) is small: F = F_P exp(-d / d*), so d ~ -d* log(F / F_P).
  auto const simulation = simulated(growing_scene(free_sliding, radial), 4.0);
  double const distance = 4.0 - 0.1 - simulation->fibers().shape(0).length;
  EXPECT_NEAR(-simulation->fibers().ends(0).plus_end.z, 4.4 * std::exp(-distance / 0.02), 1e-2);
  EXPECT_EQ(simulation->tip_state(0), TipState::pushing);
}

TEST(Pushing, plus_end_slides_or_stays) {
  auto const held = simulated(growing_scene(no_sliding, oblique), 8.0),
                   sliding = simulated(growing_scene(free_sliding, oblique), 8.0);
  Vec3d const held_end = plus_end(held->fibers().shape(0)), sliding_end = plus_end(sliding->fibers().shape(0));
  Vec3d const start{-0.7, 0, 0}, along = normalized(Vec3d{0.5, 0.2, 0.8});
  double const b = dot(start, along), reached = -b + std::sqrt(b * b - 0.7 * 0.7 + 3.88 * 3.88);  // on the sphere of 3.88
  EXPECT_LT(norm(held_end - start - reached * along), 0.2);  // F d* / F_P
  EXPECT_GT(norm(sliding_end - start - reached * along), 0.5);
  for (Vec3d x : {held_end, sliding_end}) EXPECT_LT(norm(x), 4.0);
}

TEST(Pushing, of_a_body_by_fibers_in_contact_from_the_start_converges_at_second_order) {
  // Soft contacts, which these steps resolve; chance is frozen, releases included.
  auto const place = [](double dt) {
    return test::body_after(1.6, R"(
      [fluid]
      viscosity = 0.8
      [periphery]
      shape = "ellipsoid"
      semi_axes = [9.0, 8.0, 8.0]
      [[body]]
      name = "pnc"
      shape = "sphere"
      radius = 2.0
      position = [1.0, 0.5, 0.0]
      [[aster]]
      body = "pnc"
      position = [2.6, 0.0, 0.0]
      centrosome_radius = 0.5
      opening = 100.0
      count = 5
      length = 60.0
      lengths = "exponential"
      nodes = 10
      growing = true
      [dynamic_instability]
      catastrophe_rate = 0.3
      initially_shrinking = 0.0
      [pushing]
      sliding = "none"
      range = 0.3
      spring_stiffness = 15.0
      [run]
      interactions = "local"
      accuracy = 1e-4
      seed = 3)", dt);
  };
  auto const [coarse, fine, order] = test::convergence_in_time(place, 0.08, 3);
  EXPECT_GT(norm(place(0.01) - Vec3d{1.0, 0.5, 0.0}), 0.04);
  EXPECT_GT(order, 1.7) << coarse << " " << fine;
}

TEST(Pushing, converges_at_about_second_order_in_time) {
  // With friction d* = 0.2 um: a stiffer contact moves the sliding tip within 3 ms, which these steps do not resolve.
  std::string const friction = "sliding = \"friction\"\nrange = 0.2\nspring_stiffness = 30.0\nfriction = 20.0\n";
  for (std::string const& sliding : {no_sliding, free_sliding, friction}) {
    auto const tip_after = [&](double dt) {
      std::string const steps = "adaptive = false\ntime_step = " + std::to_string(dt) + "\n";
      return plus_end(simulated(growing_scene(sliding, oblique, 4.0) + steps, 2.0)->fibers().shape(0));
    };
    // Over four halvings: the instant of contact falls differently into every step.
    auto const [coarse, fine, order] = test::convergence_in_time(tip_after, 0.1, 4);
    EXPECT_GT(order, sliding == friction ? 1.9 : 1.7) << sliding << coarse << " " << fine;
  }
}

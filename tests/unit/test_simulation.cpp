#include "system/simulation.hpp"

#include <gtest/gtest.h>

using namespace asterflow;

namespace {

Scene scene_of(std::string const& text) { return parse_scene(text, "test.toml"); }

}  // namespace

TEST(Simulation, sphere_in_open_fluid_obeys_stokes_law) {
  Simulation simulation(scene_of(R"(
    [fluid]
    viscosity = 2.5
    [[body]]
    shape = "sphere"
    radius = 1.5
    position = [3.0, -1.0, 2.0]
    force = [1.0, 2.0, -3.0]
    torque = [0.5, -1.0, 2.0]
    [run]
    interactions = "open"
  )"));
  simulation.step(0.01);
  Vector6 const motion = simulation.bodies()[0].motion();
  double const translation = 6 * M_PI * 2.5 * 1.5, rotation = 8 * M_PI * 2.5 * std::pow(1.5, 3);
  EXPECT_NEAR(motion[1], 2.0 / translation, 1e-7 / translation);
  EXPECT_NEAR(motion[5], 2.0 / rotation, 1e-7 / rotation);
}

TEST(Simulation, sphere_at_the_centre_of_a_sphere_feels_the_exact_wall_correction) {
  Simulation simulation(scene_of(R"(
    [fluid]
    viscosity = 0.7
    [periphery]
    shape = "sphere"
    radius = 3.0
    [[body]]
    shape = "sphere"
    radius = 1.0
    position = [0.0, 0.0, 0.0]
    force = [0.0, 1.0, 0.0]
    torque = [0.0, 0.0, 1.0]
    [run]
    interactions = "confined"
    accuracy = 1e-8
  )"));
  auto const report = simulation.step(0.01);
  EXPECT_GT(report.iterations, 0);
  Vector6 const motion = simulation.bodies()[0].motion();
  // physics: k = 1/3, F / (6 pi mu a U) = 2.975410, T / (8 pi mu a^3 Omega) = 27 / 26
  EXPECT_NEAR(motion[1] * 6 * M_PI * 0.7 * 2.975410, 1.0, 1e-6);
  EXPECT_NEAR(motion[5] * 8 * M_PI * 0.7 * 27.0 / 26.0, 1.0, 1e-6);
}

namespace {

// A spheroid with two clamped fibers, turned by a torque and dragged along: everything moves, turns and bends.
std::string const moving_scene = R"(
  [fluid]
  viscosity = 0.8
  [[body]]
  name = "seed"
  shape = "ellipsoid"
  semi_axes = [1.5, 1.0, 1.0]
  position = [0.0, 0.0, 0.0]
  force = [0.0, 0.0, 4.0]
  torque = [3.0, 10.0, -4.0]
  order = 8
  [[fiber]]
  body = "seed"
  position = [1.6, 0.0, 0.0]
  direction = [1.0, 0.2, 0.0]
  length = 4.0
  nodes = 8
  minus_end = "clamped"
  [[fiber]]
  body = "seed"
  position = [-1.6, 0.0, 0.0]
  direction = [-1.0, 0.0, 0.3]
  length = 3.0
  nodes = 8
  minus_end = "clamped"
  end_force = [0.0, 0.2, 0.1]
)";

Eigen::VectorXd state_after(double end, double dt, std::string const& level) {
  Simulation simulation(scene_of(moving_scene + "[run]\ninteractions = \"" + level +
                                 "\"\nadaptive = false\naccuracy = 1e-4\ngmres_tolerance = 1e-10\n"
                                 "evaluator_accuracy = 1e-12\ntime_step = " +
                                 std::to_string(dt)));
  while (simulation.time() < end) simulation.step(end);
  Eigen::VectorXd state(9);
  state << to_eigen(simulation.bodies()[0].pose().position), to_eigen(plus_end(simulation.fibers().shape(0))),
      to_eigen(plus_end(simulation.fibers().shape(1)));
  return state;
}

}  // namespace

TEST(Simulation, converges_at_second_order_in_time) {
  for (std::string const level : {"local", "open"}) {
    auto const coarse = state_after(0.8, 0.08, level), middle = state_after(0.8, 0.04, level),
               fine = state_after(0.8, 0.02, level);
    double const ratio = (coarse - middle).norm() / (middle - fine).norm();
    EXPECT_GT((coarse - middle).norm(), 1e-6) << level;  // there is an error to measure
    EXPECT_GT(ratio, 3.3) << level;                      // 4 in the limit; the first step is of first order
    EXPECT_LT(ratio, 6.0) << level;
  }
}

// Plus ends that come to the cortex on a body that turns and moves, and on a fiber that drifts.
TEST(Simulation, plus_ends_turn_back_at_the_cortex_to_second_order_in_time) {
  auto const lengths_after = [](double dt) {
    Simulation simulation(scene_of(R"(
      [periphery]
      shape = "sphere"
      radius = 6.0
      [[body]]
      shape = "sphere"
      radius = 1.0
      force = [0.0, 4.0, 3.0]
      torque = [8.0, 0.0, 0.0]
      [[fiber]]
      body = "body1"
      position = [0.0, 0.0, 1.0]
      direction = [0.0, 0.0, 1.0]
      length = 4.0
      minus_end = "clamped"
      growing = true
      [[fiber]]
      position = [-3.0, 0.0, 0.0]
      direction = [0.0, -1.0, 0.2]
      length = 4.0
      force_density = [0.0, -0.2, 0.0]
      growing = true
      [dynamic_instability]
      catastrophe_rate = 0.0
      [run]
      interactions = "local"
      accuracy = 1e-4
      adaptive = false
      time_step = )" + std::to_string(dt)));
    while (simulation.time() < 2.4) simulation.step(2.4);
    return Eigen::Vector2d(simulation.fibers().shape(0).length, simulation.fibers().shape(1).length);
  };
  auto const coarse = lengths_after(0.08), fine = lengths_after(0.02), exact = lengths_after(0.004);
  for (int fiber : {0, 1}) {
    EXPECT_LT(exact[fiber], 5.0) << fiber;                           // it has turned back
    EXPECT_LT(std::abs(coarse[fiber] - exact[fiber]), 4e-4) << fiber;  // of first order it would be 2e-3
    EXPECT_LT(std::abs(fine[fiber] - exact[fiber]), 4e-5) << fiber;
  }
}

TEST(Simulation, restart_goes_on_bit_for_bit) {
  std::string const text = moving_scene + "[run]\ninteractions = \"open\"\naccuracy = 1e-3\n";
  Simulation whole(scene_of(text)), resumed(scene_of(text));
  for (int i = 0; i < 3; ++i) whole.step(1e3);
  resumed.restore(whole.time(), whole.restart());
  for (int i = 0; i < 2; ++i) {
    auto const a = whole.step(1e3), b = resumed.step(1e3);
    EXPECT_EQ(a.time, b.time);
  }
  EXPECT_EQ(whole.bodies()[0].state(), resumed.bodies()[0].state());
  EXPECT_EQ(plus_end(whole.fibers().shape(0)), plus_end(resumed.fibers().shape(0)));
}

// Every mechanism at work, bodies that touch fibers of others, and states that only a solve would leave behind.
TEST(Simulation, with_all_mechanisms_restarts_bit_for_bit) {
  std::string const text = R"(
    [fluid]
    viscosity = 0.7
    [periphery]
    shape = "sphere"
    radius = 7.0
    [[body]]
    name = "a"
    shape = "sphere"
    radius = 2.0
    position = [2.0, 0.3, 0.0]
    force = [-20.0, 0.0, 0.0]
    order = 6
    [[body]]
    shape = "sphere"
    radius = 1.0
    position = [-1.4, 0.0, 0.4]
    motion = "prescribed"
    velocity = [0.1, 0.0, 0.0]
    order = 6
    [[aster]]
    body = "a"
    position = [0.0, 2.0, 0.0]
    length = 3.0
    count = 6
    growing = true
    [[fiber]]
    position = [-1.0, -1.5, 0.5]
    direction = [0.0, 0.0, 1.0]
    length = 2.0
    force_density = [0.0, 2.0, 0.0]
    [dynamic_instability]
    [pushing]
    sliding = "friction"
    friction = 2.0
    [cortical_pulling]
    sites = 10
    reach = 3.0
    [cytoplasmic_pulling]
    [steric_repulsion]
    range = 0.1
    fiber_body = true
    [run]
    accuracy = 1e-2
    time_step = 0.05
  )";
  Simulation whole(scene_of(text));
  for (int i = 0; i < 12; ++i) whole.step(1e3);
  Simulation resumed(scene_of(text));
  resumed.restore(whole.time(), whole.restart());
  for (int i = 0; i < 3; ++i) {
    auto const a = whole.step(1e3), b = resumed.step(1e3);
    EXPECT_EQ(a.time, b.time);
  }
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(whole.bodies()[i].state(), resumed.bodies()[i].state());
  for (std::size_t i = 0; i < whole.fibers().count(); ++i)
    EXPECT_EQ(plus_end(whole.fibers().shape(i)), plus_end(resumed.fibers().shape(i))) << i;
}

TEST(Simulation, keeps_lengths_exactly) {
  Simulation simulation(scene_of(moving_scene + "[run]\ninteractions = \"open\"\naccuracy = 1e-3\n"));
  for (int i = 0; i < 10; ++i) simulation.step(1e3);
  EXPECT_DOUBLE_EQ(simulation.fibers().shape(0).length, 4.0);
  for (Vec3d const& t : simulation.fibers().shape(0).tangents) EXPECT_NEAR(norm(t), 1.0, 1e-14);
  EXPECT_GT(simulation.fibers().elastic_energy(), 0.0);
}

TEST(Simulation, of_a_local_scene_iterates_over_nothing) {
  Simulation simulation(scene_of(moving_scene + "[run]\ninteractions = \"local\"\n"));
  EXPECT_EQ(simulation.step(1.0).iterations, 0);
  EXPECT_EQ(simulation.exchange_memory(), 0u);
}

TEST(Simulation, of_an_empty_scene_does_nothing_and_ends) {
  Simulation simulation(scene_of(""));
  simulation.step(0.01);
  EXPECT_EQ(simulation.frame().size(), 1u);
}

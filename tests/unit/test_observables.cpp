#include "observable/body_observables.hpp"
#include "observable/fiber_observables.hpp"
#include "observable/flow_observables.hpp"
#include "system/simulation.hpp"

#include <gtest/gtest.h>

using namespace asterflow;

namespace {

double value(Observables const& row, std::string const& name) {
  for (auto const& observable : row)
    if (observable.name == name) return observable.value;
  ADD_FAILURE() << "no observable " << name;
  return 0.0;
}

struct Observed {
  Observables bodies, fibers, flow;
};

Observed observed_after(std::string const& scene_text, double time) {
  Simulation simulation(parse_scene(scene_text, "test.toml"));
  while (simulation.time() < time) simulation.step(time);
  Frame const frame{simulation.time(), simulation.frame()};
  auto const fibers = stored_fibers(simulation.scene(), frame);
  return {body_observables(simulation.scene(), frame), fiber_observables(fibers),
          flow_observables(simulation.scene(), simulation.flows(), frame, fibers)};
}

std::string const ball = R"(
  [fluid]
  viscosity = 1.7
  [[body]]
  name = "ball"
  shape = "sphere"
  radius = 1.5
  position = [0.3, -0.2, 0.1]
)";

std::string const open = "[run]\ninteractions = \"open\"\naccuracy = 1e-6\n";

}  // namespace

TEST(Observables, of_a_dragged_sphere_are_those_of_stokes) {
  auto const seen = observed_after(ball + "force = [0.4, -1.2, 0.3]\ntorque = [0.0, 2.0, 0.0]\n" + open, 0.01);
  double const force = std::sqrt(0.16 + 1.44 + 0.09), speed = force / (6 * M_PI * 1.7 * 1.5);
  double const turning = 2.0 / (8 * M_PI * 1.7 * std::pow(1.5, 3));
  EXPECT_NEAR(value(seen.bodies, "ball_speed"), speed, 1e-6 * speed);
  EXPECT_NEAR(value(seen.bodies, "ball_angular_velocity_y"), turning, 1e-6 * turning);
  EXPECT_NEAR(value(seen.flow, "net_force_x"), 0.4, 1e-6);
  EXPECT_NEAR(value(seen.flow, "net_force_y"), -1.2, 1e-6);
  EXPECT_LT(value(seen.flow, "force_imbalance"), 1e-6 * force);
  // Torque about the origin: T + x_c x F.
  EXPECT_NEAR(value(seen.flow, "net_torque_z"), 0.3 * -1.2 + 0.2 * 0.4, 2e-3);  // x_c has moved a little
  // All power is dissipated: F^2 / (6 pi mu a) + T^2 / (8 pi mu a^3).
  EXPECT_NEAR(value(seen.flow, "body_power"), force * speed + 2.0 * turning, 1e-6);
  EXPECT_LT(std::abs(value(seen.flow, "force_moment_xy")), 1e-6);
}

// A rigid sphere held in a strain E takes part against it with the stresslet of Batchelor, (20/3) pi mu a^3 E: it exerts
// the opposite first moment on the fluid.
// Factors on Stokes drag: of a sphere in a sphere three times as large, of one in a flow of half its velocity.
TEST(Observables, hold_what_moves_a_prescribed_sphere) {
  struct Case {
    std::string scene;
    double drag, turning;
  };
  std::string const moved = "[fluid]\nviscosity = 1.7\n[[body]]\nname = \"ball\"\nshape = \"sphere\"\nradius = 1.5\nmotion = \"prescribed\"\n"
                            "velocity = [0.4, -1.2, 0.3]\nangular_velocity = [0.0, 2.0, 0.0]\n";
  std::string const cell = "[periphery]\nshape = \"sphere\"\nradius = 4.5\n", wind = "[background]\nvelocity = [0.2, -0.6, 0.15]\n";
  std::string const run = "[run]\naccuracy = 1e-6\ninteractions = ";
  for (Case const& one : {Case{run + "\"local\"\n", 1, 1}, Case{run + "\"open\"\n", 1, 1}, Case{wind + run + "\"local\"\n", 0.5, 1},
                          Case{wind + run + "\"open\"\n", 0.5, 1}, Case{cell + run + "\"confined\"\n", 2.975410, 1.038462}}) {
    auto const seen = observed_after(moved + one.scene, 1e-6);
    double const drag = one.drag * 6 * M_PI * 1.7 * 1.5, turning = one.turning * 8 * M_PI * 1.7 * std::pow(1.5, 3);
    EXPECT_NEAR(value(seen.bodies, "ball_force_y") / drag, -1.2, 2e-6) << one.scene;
    EXPECT_NEAR(value(seen.bodies, "ball_torque_y") / turning, 2.0, 2e-6) << one.scene;
    if (one.scene.find("local") != std::string::npos) continue;
    EXPECT_LT(value(seen.flow, "force_imbalance"), 1e-11) << one.scene;
    EXPECT_LT(value(seen.flow, "torque_imbalance"), 1e-11) << one.scene;
  }
}

TEST(Observables, hold_the_stresslet_of_a_sphere_in_strain) {
  auto const seen = observed_after(ball + "[background]\ngradient = [[0.2, 0.05, 0], [0.05, -0.1, 0], [0, 0, -0.1]]\n" + open, 0.001);
  double const factor = -20.0 / 3.0 * M_PI * 1.7 * std::pow(1.5, 3);
  EXPECT_NEAR(value(seen.flow, "force_moment_xx"), factor * 0.2, 1e-5 * std::abs(factor));
  EXPECT_NEAR(value(seen.flow, "force_moment_yy"), factor * -0.1, 1e-5 * std::abs(factor));
  EXPECT_NEAR(value(seen.flow, "force_moment_xy"), factor * 0.05, 1e-5 * std::abs(factor));
  EXPECT_NEAR(value(seen.flow, "net_force_x"), 0.0, 1e-6);
  EXPECT_GT(value(seen.flow, "puller_index"), 0.0);  // it resists extension along x
}

TEST(Observables, hold_the_moment_of_point_forces_whatever_carries_them) {
  // Two short fibers, pulled apart along x: a pusher with M_xx = 2/3 d F.
  std::string const fiber = "[[fiber]]\nlength = 1.0\nnodes = 8\nforce_density = [%, 0, 0]\nposition = [%, 0, 0]\n";
  auto const with = [&](std::string density, std::string x) {
    std::string text = fiber;
    text.replace(text.find('%'), 1, density);
    return text.replace(text.find('%'), 1, x);
  };
  auto const seen = observed_after(with("2.0", "4.5") + with("-2.0", "-5.5") + "[fluid]\nviscosity = 1.7\n" + open, 0.001);
  EXPECT_NEAR(value(seen.flow, "force_moment_xx"), 2.0 / 3.0 * 10.0 * 2.0, 0.01);
  EXPECT_NEAR(value(seen.flow, "force_moment_yy"), -1.0 / 3.0 * 10.0 * 2.0, 0.01);
  EXPECT_NEAR(value(seen.flow, "puller_index"), -1.0, 1e-3);
  EXPECT_LT(value(seen.flow, "force_imbalance"), 1e-8);
}

TEST(Observables, of_straight_fibers_have_no_bending) {
  auto const seen = observed_after("[[fiber]]\nlength = 3.0\n[[fiber]]\nlength = 5.0\nposition = [0, 4, 0]\n" + open, 0.01);
  EXPECT_NEAR(value(seen.fibers, "length_mean"), 4.0, 1e-12);
  EXPECT_NEAR(value(seen.fibers, "length_deviation"), 1.0, 1e-12);
  EXPECT_NEAR(value(seen.fibers, "length_largest"), 5.0, 1e-12);
  EXPECT_LT(value(seen.fibers, "curvature_largest"), 1e-9);
  EXPECT_LT(value(seen.fibers, "elastic_energy"), 1e-12);
  EXPECT_EQ(value(seen.fibers, "fibers_captured"), 0.0);
}

TEST(Observables, of_an_arc_hold_its_curvature_and_energy) {
  constexpr double radius = 4.0, angle = 1.2;
  std::string points;
  for (int i = 0; i <= 60; ++i) {
    double const turn = angle * i / 60;
    points += (i > 0 ? ", [" : "[") + std::to_string(radius * std::sin(turn)) + ", " +
              std::to_string(radius * (1 - std::cos(turn))) + ", 0]";
  }
  std::string const scene = "[[fiber]]\nbending_rigidity = 7.0\nnodes = 24\npoints = [" + points + "]\n";
  Simulation const simulation(parse_scene(scene + open, "test.toml"));
  auto const row = fiber_observables(stored_fibers(simulation.scene(), {0.0, simulation.frame()}));
  // The smooth curve through the points is straight at its very ends: 1 / 60 of it on each side.
  EXPECT_NEAR(value(row, "curvature_mean"), 1 / radius, 1e-2 / radius);
  EXPECT_NEAR(value(row, "elastic_energy"), 0.5 * 7.0 * angle / radius, 2e-2);
  EXPECT_NEAR(value(row, "elastic_energy"), simulation.fibers().elastic_energy(), 1e-9);
}

TEST(Observables, of_a_body_measure_the_angle_of_its_aster) {
  std::string const aster = "[[aster]]\nbody = \"ball\"\nposition = [0, 1.5, 0]\ncount = 2\nlength = 1.0\nopening = 20\n";
  Simulation const simulation(
      parse_scene(ball + "rotation_axis = [0, 0, 1]\nrotation_angle = 130\n" + aster + open, "test.toml"));
  EXPECT_NEAR(value(body_observables(simulation.scene(), {0.0, simulation.frame()}), "ball_angle"), 40.0, 1e-9);
}

TEST(Observables, of_a_closed_scene_balance_force_and_torque) {
  std::string const aster = R"(
    [[aster]]
    body = "ball"
    position = [0.0, 1.5, 0.0]
    opening = 60
    count = 6
    length = 2.0
    nodes = 8
  )";
  auto const seen = observed_after(ball + "force = [1.0, 0.5, 0.0]\n" + aster + R"(
    [periphery]
    shape = "sphere"
    radius = 6.0
    [run]
    accuracy = 1e-6
    adaptive = false
    time_step = 0.01)", 0.05);
  EXPECT_LT(value(seen.flow, "force_imbalance"), 1e-6);
  EXPECT_NEAR(value(seen.flow, "net_force_x"), 1.0, 1e-6);
  EXPECT_GT(value(seen.flow, "body_power"), 0.0);
  EXPECT_GT(value(seen.flow, "fluid_speed_ratio"), 0.0);
  EXPECT_LT(value(seen.flow, "fluid_speed_ratio"), 1.0);
  EXPECT_LT(value(seen.flow, "no_slip_residual"), 1e-3);
}

namespace {

// An aster in a cell whose plus ends reach the cortex within the first second.
std::string const crowded_cell = R"(
  [fluid]
  viscosity = 0.8
  [periphery]
  shape = "ellipsoid"
  semi_axes = [9.0, 7.0, 7.0]
  [[body]]
  name = "ball"
  shape = "sphere"
  radius = 2.0
  position = [1.0, 0.5, 0.0]
  [[aster]]
  body = "ball"
  position = [0.0, 2.0, 0.0]
  count = 12
  length = 8.0
  growing = true
  [dynamic_instability]
  [run]
  accuracy = 1e-2
)";

// Force and torque of what the cortex does to plus ends are all that is not balanced within body, fibers and fluid.
void expect_balance(std::string const& mechanism, std::string const& held) {
  auto const seen = observed_after(crowded_cell + mechanism, 1.0);
  EXPECT_GT(value(seen.fibers, held), 0.0);
  double const force = value(seen.fibers, "plus_end_force");
  EXPECT_LT(value(seen.flow, "force_imbalance"), 1e-8 * force);
  EXPECT_LT(value(seen.flow, "torque_imbalance"), 1e-8 * force * 9.0);  // the lever of the cell
}

}  // namespace

TEST(Observables, of_confined_pushing_balance_the_forces_on_plus_ends) {
  expect_balance("[pushing]\nsliding = \"none\"\n", "fibers_pushing");
  expect_balance("[pushing]\nsliding = \"friction\"\nfriction = 5.0\n", "fibers_pushing");
  expect_balance("[pushing]\nsliding = \"free\"\n", "fibers_pushing");
}

TEST(Observables, of_confined_capture_balance_the_forces_on_plus_ends) {
  expect_balance("[cortical_pulling]\nsites = 300\ncapture_rate = 20.0\n", "fibers_captured");
}

TEST(Observables, of_repelled_fibers_balance_the_forces_of_the_cortex) {
  std::string const repulsion = "[steric_repulsion]\nrange = 0.6\n";  // wide: nodes of many fibers are within it
  expect_balance("[pushing]\nsliding = \"none\"\n" + repulsion, "fibers_pushing");
  auto const seen = observed_after(crowded_cell + "[cytoplasmic_pulling]\n" + repulsion, 0.3);
  EXPECT_GT(std::abs(value(seen.flow, "net_force_x")), 0.1);  // pN, of the cortex on fibers and through them on the fluid
  EXPECT_LT(value(seen.flow, "force_imbalance"), 1e-8 * 5.0);  // of the pull of all motors: 12 fibers, 0.1 / um, 0.9 pN
}

TEST(Observables, of_a_turning_body_balance_whatever_its_shape_and_the_step) {
  for (std::string const shape :
       {"shape = \"ellipsoid\"\nsemi_axes = [2.0, 1.0, 0.6]",
        "shape = \"revolution\"\nprofile = [[-1.0, 0.0], [-0.7, 0.6], [0.0, 0.8], [0.6, 0.75], [1.0, 0.0]]"}) {
    auto const seen = observed_after("[periphery]\nshape = \"sphere\"\nradius = 8.0\n[[body]]\n" + shape + R"(
      position = [2.0, 0.0, 1.0]
      force = [-6.0, -2.0, 0.0]
      torque = [1.0, 3.0, -2.0]
      [run]
      accuracy = 1e-1)", 1.0);
    EXPECT_LT(value(seen.flow, "force_imbalance"), 1e-10 * 6.0) << shape;
    EXPECT_LT(value(seen.flow, "torque_imbalance"), 1e-10 * 6.0 * 2.0) << shape;
  }
}

TEST(Observables, of_trailing_cargo_balance_and_hold_its_stress) {
  std::string const fiber = "[fluid]\nviscosity = 1.7\n[[fiber]]\nlength = 6.0\n[cytoplasmic_pulling]\n"
                            "motor_density = 0.5\nmotor_force = 0.8\n";
  auto const seen = observed_after(fiber + "cargo_offset = 0.2\n" + open, 0.01), without = observed_after(fiber + open, 0.01);
  EXPECT_NEAR(value(seen.flow, "force_moment_xx"), -2.0 / 3.0 * 0.5 * 0.8 * 0.2 * 6.0, 1e-8);
  EXPECT_NEAR(value(seen.flow, "force_moment_yy"), 1.0 / 3.0 * 0.5 * 0.8 * 0.2 * 6.0, 1e-8);
  EXPECT_GT(value(seen.flow, "puller_index"), 0.0);
  EXPECT_LT(value(seen.flow, "force_imbalance"), 1e-12);
  EXPECT_LT(value(seen.flow, "torque_imbalance"), 1e-12);
  // The fiber does not feel its own cargo, and its motors work as before.
  EXPECT_NEAR(value(seen.flow, "motor_power"), value(without.flow, "motor_power"), 1e-12);
  EXPECT_GT(value(seen.flow, "motor_power"), 0.1);
}

TEST(Observables, of_prescribed_and_free_bodies_that_touch_balance) {
  auto const seen = observed_after(R"(
    [fluid]
    viscosity = 0.6
    [periphery]
    shape = "ellipsoid"
    semi_axes = [8.0, 6.0, 6.0]
    [[body]]
    name = "held"
    shape = "ellipsoid"
    semi_axes = [1.5, 1.0, 1.2]
    position = [-2.0, 0.3, 0.2]
    motion = "prescribed"
    velocity = [0.3, 0.0, 0.1]
    angular_velocity = [0.0, 0.2, 0.3]
    order = 8
    [[body]]
    shape = "sphere"
    radius = 1.0
    position = [0.6, 0.6, 0.0]
    force = [-30.0, 0.0, 0.0]
    order = 8
    [[fiber]]
    body = "held"
    position = [-3.5, 0.3, 0.2]
    direction = [-1.0, 0.1, 0.3]
    length = 3.0
    minus_end = "clamped"
    growing = true
    [[fiber]]
    position = [0.0, 1.8, 0.5]
    direction = [0.3, 0.1, 1.0]
    length = 2.0
    force_density = [0.0, -1.0, -0.5]
    [dynamic_instability]
    [cytoplasmic_pulling]
    [steric_repulsion]
    range = 0.1
    fiber_body = true
    [run]
    accuracy = 1e-2
  )", 0.6);
  EXPECT_LT(value(seen.flow, "force_imbalance"), 1e-11);
  EXPECT_LT(value(seen.flow, "torque_imbalance"), 1e-3);  // a fiber with free ends; see docs/observables.md
  EXPECT_GT(std::abs(value(seen.bodies, "held_force_x")), 1.0);
}

TEST(Observables, of_a_body_against_the_cortex_balance_its_force) {
  auto const seen = observed_after(R"(
    [periphery]
    shape = "sphere"
    radius = 6.0
    [[body]]
    name = "ball"
    shape = "sphere"
    radius = 1.5
    position = [4.0, 0.0, 0.0]
    force = [20.0, 0.0, 0.0]
    [steric_repulsion]
    range = 0.6
    [run]
    accuracy = 1e-2)", 0.2);
  EXPECT_LT(value(seen.flow, "net_force_x"), 19.0);
  EXPECT_LT(value(seen.flow, "force_imbalance"), 1e-8 * 20.0);
}

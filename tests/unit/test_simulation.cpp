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

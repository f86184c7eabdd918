#include "system/placement.hpp"

#include "base/error.hpp"
#include "system/simulation.hpp"

#include <gtest/gtest.h>

using namespace asterflow;

namespace {

Scene scene_of(std::string const& text) { return parse_scene(text, "test.toml"); }

// A sphere with one clamped fiber is pulled towards the wall of a spherical cell.
std::string const towards_the_wall = R"(
  [fluid]
  viscosity = 0.8
  [periphery]
  shape = "sphere"
  radius = 4.0
  [[body]]
  name = "ball"
  shape = "sphere"
  radius = 1.0
  position = [1.0, 0.0, 0.0]
  force = [300.0, 0.0, 0.0]
  [[fiber]]
  body = "ball"
  position = [2.0, 0.0, 0.0]
  direction = [1.0, 0.0, 0.0]
  length = 1.9
  minus_end = "clamped"
  [run]
  accuracy = 1e-2
  min_time_step = 1e-4
)";

std::string reason_to_stop(Simulation& simulation) {
  try {
    while (simulation.time() < 100.0) simulation.step(100.0);
  } catch (NumericalError const& error) {
    return error.what();
  }
  return "none";
}

}  // namespace

TEST(Placement, names_the_fiber_that_leaves_and_keeps_the_last_state) {
  Simulation simulation(scene_of(towards_the_wall));
  std::string const reason = reason_to_stop(simulation);
  EXPECT_NE(reason.find("[[fiber]] #1 on body \"ball\" reaches outside the periphery"), std::string::npos) << reason;
  EXPECT_NE(reason.find("([steric_repulsion] with fiber_cortex = true may hold it back)"), std::string::npos) << reason;
  EXPECT_NE(reason.find("t = 0."), std::string::npos) << reason;
  EXPECT_GT(simulation.time(), 0.0);
  EXPECT_LT(plus_end(simulation.fibers().shape(0)).x, 4.0 * (1 + 1e-3));
  EXPECT_GT(plus_end(simulation.fibers().shape(0)).x, 3.99);  // smaller steps went almost to the wall
}

TEST(Placement, a_failed_attempt_changes_nothing) {
  Simulation simulation(scene_of(towards_the_wall));
  std::vector<NamedArray> before;
  auto const step_until_it_fails = [&] {
    for (int i = 0; i < 1000; ++i) {
      before = simulation.restart();
      simulation.step(100.0);
    }
  };
  EXPECT_THROW(step_until_it_fails(), NumericalError);
  auto const after = simulation.restart();
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t i = 0; i < before.size(); ++i)
    if (before[i].name != "step/next") {
      EXPECT_EQ(before[i].values, after[i].values) << before[i].name;
    }
}

TEST(Placement, names_bodies_that_touch_the_periphery_or_each_other) {
  std::string const two = R"(
    [periphery]
    shape = "sphere"
    radius = 6.0
    [[body]]
    name = "left"
    shape = "sphere"
    radius = 1.0
    position = [-1.5, 0.0, 0.0]
    force = [50.0, 0.0, 0.0]
    [[body]]
    name = "right"
    shape = "sphere"
    radius = 1.0
    position = [1.5, 0.0, 0.0]
    [run]
    interactions = "local"
  )";
  Simulation meeting(scene_of(two));
  EXPECT_NE(reason_to_stop(meeting).find("body \"right\" overlaps body \"left\""), std::string::npos);
  auto leaving_scene = scene_of(two);
  leaving_scene.bodies[0].force = {-50, 0, 0};
  Simulation leaving(leaving_scene);
  EXPECT_NE(reason_to_stop(leaving).find("body \"left\" touches the periphery"), std::string::npos);
}

TEST(Placement, counts_fibers_as_the_scene_file_does) {
  auto const scene = scene_of(R"(
    [[body]]
    name = "seed"
    shape = "sphere"
    radius = 1.0
    [[fiber]]
    position = [5, 0, 0]
    [[aster]]
    position = [0, 9, 0]
    count = 2
    [[aster]]
    body = "seed"
    position = [0, 2, 0]
    count = 2
  )");
  EXPECT_EQ(fiber_words(scene, 0), "[[fiber]] #1");
  EXPECT_EQ(fiber_words(scene, 2), "fiber 2 of [[aster]] #1");
  EXPECT_EQ(fiber_words(scene, 3), "fiber 1 of [[aster]] #2 on body \"seed\"");
}

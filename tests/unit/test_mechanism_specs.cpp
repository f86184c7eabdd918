// Bad input of the active mechanisms is refused with the key's name.

#include "base/error.hpp"
#include "io/scene.hpp"

#include <gtest/gtest.h>

using namespace asterflow;

namespace {

std::string const cell = R"(
  [periphery]
  shape = "sphere"
  radius = 6.0
  [[body]]
  name = "pnc"
  shape = "sphere"
  radius = 2.0
  [[aster]]
  body = "pnc"
  position = [0, 2, 0]
  count = 3
  length = 1.0
  growing = true
  [dynamic_instability]
)";

std::string refusal(std::string const& text) {
  try {
    parse_scene(text, "test.toml");
  } catch (SceneError const& error) {
    return error.what();
  }
  return "accepted";
}

void expect_refusal(std::string const& table, std::string const& names) {
  EXPECT_NE(refusal(cell + table).find(names), std::string::npos) << refusal(cell + table);
}

}  // namespace

TEST(MechanismSpecs, good_tables_are_accepted_together) {
  EXPECT_EQ(refusal(cell + "[pushing]\nsliding = \"none\"\n[cytoplasmic_pulling]\n[cortical_pulling]\n"
                           "positions = [[0, 0, 6]]\ndividing_body = \"pnc\"\n[steric_repulsion]\n"),
            "accepted");
}

TEST(MechanismSpecs, models_of_growing_fibers_need_one) {
  std::string still = cell;
  still.replace(still.find("growing = true"), 14, "growing = false");
  for (char const* table : {"[pushing]\nsliding = \"free\"\n", "[cortical_pulling]\n"})
    EXPECT_NE(refusal(still + table).find("fibers with growing = true"), std::string::npos) << refusal(still + table);
}

TEST(MechanismSpecs, mechanisms_without_anything_to_act_on_are_refused) {
  std::string const ball = "[[body]]\nshape = \"sphere\"\nradius = 2\n", periphery = "[periphery]\nshape = \"sphere\"\nradius = 6\n",
                    fiber = "[[fiber]]\nposition = [2, 0, 0]\nlength = 1\n";
  EXPECT_NE(refusal(ball + "[cytoplasmic_pulling]\n").find("[cytoplasmic_pulling]: needs a [[fiber]]"), std::string::npos);
  EXPECT_EQ(refusal(fiber + "[cytoplasmic_pulling]\n"), "accepted");
  std::string const repulsion = "[steric_repulsion]\n", nothing = "[steric_repulsion]: has nothing to repel";
  EXPECT_NE(refusal(ball + fiber + repulsion).find(nothing), std::string::npos);
  EXPECT_NE(refusal(periphery + repulsion).find(nothing), std::string::npos);
  EXPECT_NE(refusal(periphery + ball + repulsion + "body_cortex = false\nfiber_body = true\n").find(nothing), std::string::npos);
  EXPECT_EQ(refusal(periphery + ball + repulsion), "accepted");
  EXPECT_EQ(refusal(periphery + fiber + repulsion), "accepted");
  EXPECT_EQ(refusal(ball + fiber + repulsion + "fiber_body = true\n"), "accepted");
}

TEST(MechanismSpecs, ranges_wider_than_the_cell_are_refused) {
  expect_refusal("cortex_margin = 6\n", "[dynamic_instability]: cortex_margin = 6: must be less than 6 um, the least radius");
  expect_refusal("minimal_length = 9\n", "[dynamic_instability]: minimal_length = 9: must be less than 6 um, the least radius");
  expect_refusal("cortex_margin = 1\n[pushing]\nsliding = \"none\"\nrange = 5\n", "[pushing]: range = 5: must be less than 5 um");
  expect_refusal("[steric_repulsion]\nrange = 7\n", "[steric_repulsion]: range = 7: must be less than 6 um");
}

TEST(MechanismSpecs, growing_fibers_are_slender_at_every_length) {
  expect_refusal("minimal_length = 0.04\n", "radius: must be at most a quarter of minimal_length = 0.04 um");
  EXPECT_EQ(refusal(cell + "minimal_length = 0.05\n"), "accepted");
}

TEST(MechanismSpecs, wrong_signs_and_probabilities_over_one_are_refused) {
  expect_refusal("rescue_rate = -1\n", "rescue_rate = -1");
  expect_refusal("initially_shrinking = 1.5\n", "initially_shrinking = 1.5");
  expect_refusal("cortex_margin = -0.1\n", "cortex_margin = -0.1");
  expect_refusal("[cytoplasmic_pulling]\nmotor_density = -0.1\n", "motor_density = -0.1");
  expect_refusal("[cytoplasmic_pulling]\nstall_force = 0\n", "stall_force = 0");
  expect_refusal("[cytoplasmic_pulling]\ncargo_offset = -0.1\n", "cargo_offset = -0.1");
  expect_refusal("[pushing]\nsliding = \"none\"\nstall_force = -4.4\n", "stall_force = -4.4");
  expect_refusal("[pushing]\nsliding = \"none\"\nminimal_catastrophe_rate = -0.2\n", "minimal_catastrophe_rate = -0.2");
  expect_refusal("[cortical_pulling]\npull_force = -3\n", "pull_force = -3");
  expect_refusal("[cortical_pulling]\nresidence_time = 0\n", "residence_time = 0");
  expect_refusal("[cortical_pulling]\ncapture_rate = -1\n", "capture_rate = -1");
}

TEST(MechanismSpecs, contradictions_are_refused) {
  expect_refusal("[pushing]\n", "sliding");
  expect_refusal("[pushing]\nsliding = \"free\"\nspring_stiffness = 40\n", "spring_stiffness = 40");
  expect_refusal("[pushing]\nsliding = \"none\"\nfriction = 2\n", "friction = 2");
  expect_refusal("[pushing]\nsliding = \"friction\"\n", "friction: is needed");
  expect_refusal("[cytoplasmic_pulling]\nmotor_force = 1\nstall_force = 2\n", "stall_force = 2");
  expect_refusal("[cortical_pulling]\nsites = 3\npositions = [[0, 0, 6]]\n", "sites = 3");
  expect_refusal("[cortical_pulling]\narrangement = \"even\"\npositions = [[0, 0, 6]]\n", "arrangement");
  expect_refusal("[cortical_pulling]\ndividing_body = \"pnc\"\ndividing_plane = 1.0\n", "dividing_plane = 1");
}

TEST(MechanismSpecs, sites_off_the_cortex_and_unknown_bodies_are_refused) {
  expect_refusal("[cortical_pulling]\npositions = [[0, 0, 6], [0, 0, 7]]\n", "[0, 0, 7] um lies 1 um outside the cortex");
  expect_refusal("[cortical_pulling]\ndividing_body = \"pcn\"\n", "pnc");
}

TEST(MechanismSpecs, cortex_mechanisms_need_a_cortex_and_growing_plus_ends) {
  std::string const free_fiber = "[[fiber]]\nminus_end = \"clamped\"\n[dynamic_instability]\n";
  EXPECT_NE(refusal(free_fiber + "[pushing]\nsliding = \"free\"\n").find("[periphery]"), std::string::npos);
  EXPECT_NE(refusal("[periphery]\nshape = \"sphere\"\nradius = 6\n[cortical_pulling]\n").find("[dynamic_instability]"),
            std::string::npos);
  std::string const in_space = "[periphery]\nshape = \"sphere\"\nradius = 6\n[[fiber]]\nminus_end = \"clamped\"\n"
                               "growing = true\n[dynamic_instability]\n[pushing]\nsliding = \"none\"\n";
  EXPECT_NE(refusal(in_space).find("spring_stiffness"), std::string::npos) << refusal(in_space);
}

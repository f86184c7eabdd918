#include "base/error.hpp"
#include "io/scene.hpp"
#include "io/scene_geometry.hpp"

#include <gtest/gtest.h>
#include <numbers>

using namespace asterflow;

namespace {

std::string const minimal = R"([fluid]
viscosity = 1.5

[periphery]
shape = "ellipsoid"
semi_axes = [25.0, 15.0, 15.0]

[[body]]
name = "pnc"
shape = "sphere"
radius = 5.0
position = [10.0, 0.0, 0.0]
force = [10.0, 0.0, 0.0]

[run]
interactions = "confined"
accuracy = 1e-6
)";

Scene read(std::string const& text, std::vector<std::string> const& overrides = {}) {
  return parse_scene(text, "scene.toml", overrides);
}

std::string refusal(std::string const& text, std::vector<std::string> const& overrides = {}) {
  try {
    read(text, overrides);
  } catch (SceneError const& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace

TEST(Scene, Reads_the_minimal_scene) {
  Scene const scene = read(minimal);
  EXPECT_EQ(scene.fluid.viscosity, 1.5);
  ASSERT_TRUE(scene.periphery);
  EXPECT_EQ(scene.periphery->shape.semi_axes.x, 25.0);
  ASSERT_EQ(scene.bodies.size(), 1u);
  EXPECT_EQ(scene.bodies[0].force.x, 10.0);
  EXPECT_EQ(scene.run.interactions, Interactions::confined);
  EXPECT_EQ(scene.run.gmres_tolerance, 1e-7);
  EXPECT_EQ(scene.text, minimal);
}

TEST(Scene, Holds_nothing_that_the_file_does_not_have) {
  Scene const scene = read("");
  EXPECT_FALSE(scene.periphery);
  EXPECT_FALSE(scene.background);
  EXPECT_TRUE(scene.bodies.empty());
  EXPECT_EQ(scene.run.interactions, Interactions::open);
}

TEST(Scene, Refuses_a_confined_run_without_periphery) {
  EXPECT_EQ(refusal("[run]\ninteractions = \"confined\"\n"),
            "scene.toml: [run]: interactions = 'confined': needs a [periphery]; without one choose local or open "
            "[line 2]");
}

TEST(Scene, Refuses_a_background_flow_in_a_confined_run) {
  EXPECT_EQ(refusal(minimal + "[background]\nvelocity = [1, 0, 0]\n").substr(0, 54),
            "scene.toml: [background]: is a flow in unbounded fluid");
}

TEST(Scene, Refuses_two_bodies_of_one_name) {
  EXPECT_EQ(refusal(minimal + "[[body]]\nname = \"pnc\"\nshape = \"sphere\"\nradius = 1\nposition = [-9,0,0]\n"),
            "scene.toml: [[body]] #2: name = 'pnc': is the name of [[body]] #1 too [line 19]");
}

TEST(Scene, Refuses_an_unknown_table) {
  EXPECT_NE(refusal("[fluids]\nviscosity = 1\n").find("unknown key \"fluids\" (did you mean \"fluid\"?"),
            std::string::npos);
}

TEST(Scene, Refuses_keys_that_the_kind_of_motion_ignores) {
  EXPECT_EQ(refusal(minimal, {"body.pnc.velocity=[1,0,0]"}),
            "scene.toml: [[body]] #1: velocity = [1, 0, 0] (--set): needs motion = \"prescribed\"; a free body moves "
            "by force and torque");
}

TEST(Scene, Turns_axis_and_angle_into_a_quaternion) {
  Scene const scene = read(minimal, {"body.0.rotation_axis=[0,0,2]", "body.0.rotation_angle=90"});
  Eigen::Vector3d const turned = scene.bodies[0].orientation * Eigen::Vector3d::UnitX();
  EXPECT_NEAR(turned.y(), 1.0, 1e-15);
}

TEST(Scene, Refuses_a_quaternion_that_is_not_unit) {
  EXPECT_NE(refusal(minimal, {"body.0.orientation=[1,1,0,0]"}).find("must be a unit quaternion"), std::string::npos);
}

TEST(Scene, Needs_the_size_that_goes_with_a_shape) {
  EXPECT_EQ(refusal("[periphery]\nshape = \"sphere\"\n"), "scene.toml: [periphery]: key \"radius\" is missing [line 1]");
  EXPECT_EQ(refusal("[periphery]\nshape = \"cube\"\n"),
            "scene.toml: [periphery]: shape = 'cube': must be one of sphere, ellipsoid, revolution [line 2]");
}

TEST(Scene, Refuses_a_compressible_background) {
  EXPECT_NE(refusal("[background]\ngradient = [[1,0,0],[0,0,0],[0,0,0]]\n").find("must have trace 0"),
            std::string::npos);
  EXPECT_EQ(read("[background]\nshear_rate = 2.0\n").background->gradient[0].y, 2.0);
}

TEST(Scene, Refuses_an_unknown_evaluator_and_names_the_known_ones) {
  EXPECT_NE(refusal("[run]\nevaluator = \"magic\"\n").find("must be one of auto, "), std::string::npos);
}

TEST(Scene, Refuses_step_limits_that_contradict_each_other) {
  EXPECT_NE(refusal("[run]\nmin_time_step = 1.0\nmax_time_step = 0.5\n").find("must not exceed max_time_step"), std::string::npos);
  EXPECT_NE(refusal("[run]\nadaptive = false\nmax_time_step = 0.5\n").find("has no use with adaptive = false"),
            std::string::npos);
}

TEST(Scene, Reads_the_levels_of_the_drag_study) {
  Scene const scene = read("[drag]\nlevels = [\"open\"]\nfiber_counts = [0, 50]\n");
  ASSERT_EQ(scene.drag.levels.size(), 1u);
  EXPECT_EQ(scene.drag.levels[0], Interactions::open);
  EXPECT_NE(refusal("[drag]\nlevels = [\"opened\"]\n").find("must be one of local, open, confined"), std::string::npos);
}

TEST(Scene, Refuses_overlapping_bodies) {
  std::string const second = "[[body]]\nshape = \"sphere\"\nradius = 2\nposition = [10, 6.9, 0]\n";
  EXPECT_EQ(refusal(minimal + second),
            "scene.toml: [[body]] #2: overlaps [[body]] #1 \"pnc\"; move one of them [line 18]");
  EXPECT_EQ(refusal(minimal + second, {"body.1.position=[10, 7.001, 0]"}), "accepted");
  EXPECT_NE(refusal(minimal + second, {"body.1.position=[10, 0, 0]"}).find("overlaps"), std::string::npos);
}

TEST(Scene, Sees_the_gap_between_turned_ellipsoids) {
  std::string const pair = R"(
[[body]]
shape = "ellipsoid"
semi_axes = [3, 1, 1]
[[body]]
shape = "ellipsoid"
semi_axes = [3, 1, 1]
position = [0, 3.9, 0]
rotation_axis = [0, 0, 1]
rotation_angle = 90
)";
  EXPECT_NE(refusal(pair).find("overlaps"), std::string::npos);
  EXPECT_EQ(refusal(pair, {"body.1.position=[0, 4.0001, 0]"}), "accepted");
  EXPECT_EQ(refusal(pair, {"body.1.rotation_angle=0"}), "accepted");
}

TEST(Scene, Refuses_a_body_that_reaches_outside_the_periphery) {
  EXPECT_EQ(refusal(minimal, {"body.pnc.position=[20.1, 0, 0]"}).substr(0, 54),
            "scene.toml: [[body]] #1: reaches outside the periphery");
  EXPECT_NE(refusal(minimal, {"body.pnc.position=[0, 0, 10.001]"}).find("reaches outside"), std::string::npos);
  EXPECT_EQ(refusal(minimal, {"body.pnc.position=[0, 0, 9.999]"}), "accepted");
  EXPECT_NE(refusal(minimal, {"body.pnc.position=[100, 0, 0]"}).find("reaches outside"), std::string::npos);
  EXPECT_NE(refusal(minimal, {"body.pnc.radius=40"}).find("reaches outside"), std::string::npos);
}

TEST(Scene, Refuses_a_fiber_of_an_unknown_body) {
  EXPECT_EQ(refusal(minimal + "[[fiber]]\nminus_end = \"clamped\"\nbody = \"pcn\"\n"),
            "scene.toml: [[fiber]] #1: body = 'pcn': must be the name of a [[body]] (known: pnc) [line 20]");
}

TEST(Scene, Refuses_a_fiber_outside_the_periphery) {
  EXPECT_EQ(refusal(minimal + "[[fiber]]\nposition = [-20, 0, 0]\ndirection = [-1, 0, 0]\nlength = 6\n").substr(0, 55),
            "scene.toml: [[fiber]] #1: reaches outside the periphery");
  EXPECT_EQ(refusal(minimal + "[[fiber]]\nposition = [-20, 0, 0]\ndirection = [-1, 0, 0]\nlength = 4.99\n"), "accepted");
}

TEST(Scene, Refuses_a_fiber_through_a_body) {
  EXPECT_EQ(refusal(minimal + "[[fiber]]\nposition = [0, 0, 0]\nlength = 8\n").substr(0, 54),
            "scene.toml: [[fiber]] #1: passes through [[body]] #1 \"");
  EXPECT_EQ(refusal(minimal + "[[fiber]]\nposition = [10, 5, 0]\ndirection = [0, 1, 0]\nbody = \"pnc\"\n"
                              "minus_end = \"clamped\"\n"),
            "accepted");
  std::string const around = "[[fiber]]\npoints = [[10, 7, 0], [16, 4, 0], [17, -1, 0]]\n";
  EXPECT_EQ(refusal(minimal + around), "accepted");
  std::string const through = "[[fiber]]\npoints = [[4, 0, 0], [16, 0, 0]]\n";  // both ends lie beside the body
  EXPECT_NE(refusal(minimal + through).find("passes through [[body]] #1"), std::string::npos);
}

TEST(Scene, Refuses_an_aster_without_room) {
  std::string const aster = "[[aster]]\nbody = \"pnc\"\nposition = [0, 5, 0]\n";
  EXPECT_EQ(refusal(minimal + aster), "accepted");
  EXPECT_NE(refusal(minimal + aster, {"aster.0.opening=180"}).find("has no room"), std::string::npos);
}

TEST(Scene, Reach_ends_at_the_first_surface) {
  Scene const scene = read(minimal);
  PlacedScene const placed(scene.bodies, &scene.periphery->shape);
  EXPECT_NEAR(placed.reach({0, 0, 0}, {1, 0, 0}, 100), 5.0, 0.01);    // the body's near side
  EXPECT_NEAR(placed.reach({0, 0, 0}, {-1, 0, 0}, 100), 25.0, 0.01);  // the cortex
  EXPECT_NEAR(placed.reach({5, 0, 0}, {-1, 0, 0}, 100), 30.0, 0.01);  // from the body's surface
  EXPECT_EQ(placed.reach({0, 0, 0}, {0, 1, 0}, 3.0), 3.0);
}

TEST(Scene, Refuses_growth_without_its_rates) {
  EXPECT_EQ(refusal("[[fiber]]\ngrowing = true\n"),
            "scene.toml: [[fiber]] #1: growing = true: needs a table [dynamic_instability] [line 2]");
  EXPECT_EQ(refusal("[[fiber]]\ngrowing = true\n[dynamic_instability]\n"), "accepted");
}

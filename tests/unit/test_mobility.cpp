#include "system/mobility.hpp"

#include <gtest/gtest.h>

using namespace asterflow;

namespace {

std::string const sphere_in_ellipsoid = R"(
  [fluid]
  viscosity = 1.7
  [periphery]
  shape = "ellipsoid"
  semi_axes = [25.0, 15.0, 15.0]
  [[body]]
  name = "pnc"
  shape = "sphere"
  radius = 5.0
  position = [10.0, 3.0, -2.0]
)";

std::string const aster = R"(
  [[aster]]
  body = "pnc"
  position = [0.0, 5.0, 0.0]
  axis = [0.0, 1.0, 0.0]
  centrosome_radius = 1.0
  opening = 70.0
  count = 12
  length = 4.0
  nodes = 8
  arrangement = "even"
)";

}  // namespace

TEST(Mobility, resistance_of_a_body_in_a_cell_is_symmetric_and_above_that_in_open_fluid) {
  auto const m = scene_mobility(parse_scene(sphere_in_ellipsoid, "test.toml"));
  ASSERT_EQ(m.resistance.rows(), 6);
  EXPECT_LT((m.resistance - m.resistance.transpose()).norm(), 1e-4 * m.resistance.norm());
  EXPECT_GT(m.resistance(0, 0), 6 * M_PI * 1.7 * 5.0);
  EXPECT_GT(m.resistance(5, 5), 8 * M_PI * 1.7 * 125.0);
  EXPECT_LT((m.resistance * m.mobility - Eigen::MatrixXd::Identity(6, 6)).norm(), 1e-8);
}

TEST(Mobility, fibers_add_resistance_symmetrically_at_every_level) {
  double last = 0.0;
  for (std::string const level : {"open", "confined", "local"}) {
    auto const m =
        scene_mobility(parse_scene(sphere_in_ellipsoid + aster + "[run]\ninteractions = \"" + level + "\"\n", "test.toml"));
    EXPECT_LT((m.resistance - m.resistance.transpose()).norm(), 2e-2 * m.resistance.norm()) << level;
    if (level != "local") {
      EXPECT_GT(m.resistance(0, 0), last) << level;  // a no-slip wall only adds drag
    }
    last = m.resistance(0, 0);
  }
}

// Lorentz' reciprocal theorem, two different bodies in open fluid: the 12 x 12 matrix is symmetric and positive.
TEST(Mobility, of_two_bodies_is_one_symmetric_positive_matrix) {
  auto const m = scene_mobility(parse_scene(R"(
    [[body]]
    shape = "sphere"
    radius = 1.0
    position = [0.0, 0.0, 0.0]
    [[body]]
    shape = "ellipsoid"
    semi_axes = [2.0, 1.0, 1.0]
    position = [0.0, 4.0, 1.0]
    [run]
    interactions = "open"
    accuracy = 1e-6
  )", "test.toml"));
  ASSERT_EQ(m.resistance.rows(), 12);
  EXPECT_LT((m.resistance - m.resistance.transpose()).norm(), 1e-5 * m.resistance.norm());
  EXPECT_LT(m.resistance(0, 6), 0.0);  // a body carried along with another is pulled, not pushed
}

#include "system/no_slip.hpp"

#include "system/simulation.hpp"

#include <gtest/gtest.h>

using namespace asterflow;

namespace {

NoSlipResidual residual_after_a_step(std::string const& accuracy, std::string const& level) {
  Simulation simulation(parse_scene(R"(
    [fluid]
    viscosity = 1.7
    [periphery]
    shape = "ellipsoid"
    semi_axes = [5.0, 4.0, 4.0]
    [[body]]
    shape = "ellipsoid"
    semi_axes = [1.2, 1.0, 1.0]
    position = [0.5, -0.3, 0.2]
    force = [3.0, 1.0, 0.0]
    torque = [0.0, 2.0, 1.0]
    [run]
    accuracy = )" + accuracy + "\ninteractions = \"" + level + "\"", "test.toml"));
  simulation.step(0.1);
  return no_slip_residual(StoredFlow(simulation.scene(), simulation.flows(), {simulation.time(), simulation.frame()}));
}

}  // namespace

TEST(NoSlip, is_met_between_the_nodes_to_the_accuracy_asked_for) {
  for (std::string const accuracy : {"1e-2", "1e-4"}) {
    NoSlipResidual const residual = residual_after_a_step(accuracy, "confined");
    EXPECT_GT(residual.speed, 0.05);  // F / (6 pi mu a) is 0.1 in open fluid
    EXPECT_GT(residual.relative(), 0.0);
    EXPECT_LT(residual.relative(), std::stod(accuracy));
  }
}

TEST(NoSlip, has_no_periphery_in_open_fluid) {
  NoSlipResidual const residual = residual_after_a_step("1e-3", "open");
  EXPECT_EQ(residual.periphery, 0.0);
  EXPECT_LT(residual.relative(), 1e-3);
}

TEST(NoSlip, is_no_ratio_of_rounding_errors_at_rest) {
  EXPECT_EQ((NoSlipResidual{.periphery = 1e-17, .bodies = 0.0, .speed = 5e-16}).relative(), 0.0);
  EXPECT_EQ((NoSlipResidual{.periphery = 2e-8, .bodies = 1e-9, .speed = 1e-6}).relative(), 0.02);
}

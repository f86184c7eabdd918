// The fast sum's kernels for any execution space against its host loops, which sum the same pairs and modes, and against
// the double loop.

#include "backends/backend.hpp"
#include "backends/fast.hpp"
#include "kernels/list.hpp"
#include "point_sets.hpp"

#include <gtest/gtest.h>

using namespace asterflow;

namespace {

// Velocities, then gradients.
PointArray sum(Evaluator& evaluator, PointSet const& c, bool with_gradient) {
  evaluator.set_points(c.sources, c.targets, c.normals);
  PointArray result((with_gradient ? 4 : 1) * c.targets.size());
  evaluator.add_velocity(c.strengths, Points(result).first(c.targets.size()));
  if (with_gradient) evaluator.add_gradient(c.strengths, Points(result).subspan(c.targets.size()));
  return result;
}

FastInstructions host() {
  return has_avx512() ? FastInstructions::avx512 : has_avx2() ? FastInstructions::avx2 : FastInstructions::portable;
}

void expect_agreement(std::string_view kernel, double accuracy, PointSet const& c, bool with_gradient, std::string const& what) {
  FastParameters const parameters = fast_parameters(kernel, accuracy, with_gradient);
  PointArray const on_host = sum(*make_fast(kernel, parameters, host(), "host"), c, with_gradient);
  PointArray const on_device = sum(*make_fast(kernel, parameters, FastInstructions::device, "device"), c, with_gradient);
  // The host's 1 / |r| is an estimate, with 4 digits in float and 8 in double, or refined once.
  double const bound = parameters.refinement_steps > 0 ? (!parameters.single ? 1e-13 : parameters.sums_in_double ? 1e-6 : 2e-6) : parameters.single ? 2e-4 : 1e-7;
  EXPECT_LE(relative_difference(on_device, on_host), bound) << what;
  PointArray const exact = sum(*make_reference(kernel, {}), c, with_gradient);
  EXPECT_LE(relative_difference(on_device, exact), accuracy) << what;
}

}  // namespace

class DeviceSum : public testing::TestWithParam<std::string> {};

TEST_P(DeviceSum, agrees_with_host_loops_and_the_double_loop) {
  for (std::string const distribution : {"sphere", "fibers", "line", "clusters"})
    expect_agreement(GetParam(), distribution == "fibers" ? 1e-6 : 1e-3, point_set(GetParam(), distribution, 600), false, distribution);
  for (double accuracy : {1e-4, 1e-9})
    expect_agreement(GetParam(), accuracy, point_set(GetParam(), "uniform", 400), false, std::to_string(-std::log10(accuracy)));
}

TEST_P(DeviceSum, has_the_same_gradient) {
  for (double accuracy : {1e-3, 1e-6})
    expect_agreement(GetParam(), accuracy, point_set(GetParam(), "uniform", 400), true, std::to_string(-std::log10(accuracy)));
}

TEST_P(DeviceSum, takes_pairs_that_nearly_touch) {
  expect_agreement(GetParam(), 1e-3, point_set(GetParam(), "nearly touching", 800), false, "");
}

TEST_P(DeviceSum, takes_targets_that_are_not_sources) {
  PointSet c = point_set(GetParam(), "sphere", 900);
  c.targets.clear();
  for (long i = 0; i < 333; ++i) c.targets.push_back(20.0 * random_vector(i, 9));
  expect_agreement(GetParam(), 1e-6, c, false, "");
}

TEST_P(DeviceSum, follows_points_that_move_and_change_in_number) {
  auto const parameters = fast_parameters(GetParam(), 1e-3);
  auto const device = make_fast(GetParam(), parameters, FastInstructions::device, "device");
  for (long n : {600, 400, 900}) {
    PointSet const c = point_set(GetParam(), n == 400 ? "fibers" : "uniform", n);
    auto const fresh = make_fast(GetParam(), parameters, FastInstructions::device, "device");
    EXPECT_EQ(relative_difference(sum(*device, c, false), sum(*fresh, c, false)), 0.0) << n;
  }
}

INSTANTIATE_TEST_SUITE_P(kernels, DeviceSum,
                         testing::Values("stokeslet", "stresslet", "rotlet", "stokeslet_pressure", "stresslet_pressure"),
                         [](auto const& kernel) { return kernel.param; });

// The fast sum's kernels for any execution space against its host loops, which sum the same pairs and modes, and against
// the double loop.

#include "backends/backend.hpp"
#include "backends/fast.hpp"
#include "base/random.hpp"
#include "kernels/list.hpp"

#include <gtest/gtest.h>

using namespace asterflow;

namespace {

Vec3d random_vector(long i, int stream) {
  return {uniform_random(3, i, stream, 0) - 0.5, uniform_random(3, i, stream, 1) - 0.5, uniform_random(3, i, stream, 2) - 0.5};
}

Vec3d random_point(std::string const& distribution, long i) {
  Vec3d const p = random_vector(i, 0);
  if (distribution == "sphere") return normalized(p);
  if (distribution == "line") return p.x * Vec3d{3.0, -2.0, 0.5};
  if (distribution == "clusters") return p + Vec3d{i % 2 == 0 ? 0.0 : 40.0, 0.0, 3.0};
  if (distribution == "aster") return (5.0 + 10.0 * (p.x + 0.5)) * normalized(random_vector(i % 20, 7));
  if (distribution == "nearly touching") return random_vector(i / 2, 0) + (i % 2 == 0 ? 1e-10 : 0.0) * Vec3d{1.0, 2.0, 0.0};
  return p;
}

struct Case {
  PointArray points, targets, strengths, normals;
};

Case make_case(std::string_view kernel, std::string const& distribution, long n) {
  Case c;
  for (long i = 0; i < n; ++i) {
    c.points.push_back(random_point(distribution, i));
    c.strengths.push_back(random_vector(i, 1));
    if (kernel.starts_with("stresslet")) c.normals.push_back(normalized(random_vector(i, 2)));
  }
  c.targets = c.points;
  return c;
}

// Velocities, then gradients.
PointArray sum(Evaluator& evaluator, Case const& c, bool with_gradient) {
  evaluator.set_points(c.points, c.targets, c.normals);
  PointArray result((with_gradient ? 4 : 1) * c.targets.size());
  evaluator.add_velocity(c.strengths, Points(result).first(c.targets.size()));
  if (with_gradient) evaluator.add_gradient(c.strengths, Points(result).subspan(c.targets.size()));
  return result;
}

double difference(PointArray const& a, PointArray const& b) {
  double error = 0.0, size = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    error += dot(a[i] - b[i], a[i] - b[i]);
    size += dot(b[i], b[i]);
  }
  return std::sqrt(error / size);
}

FastInstructions host() {
  return has_avx512() ? FastInstructions::avx512 : has_avx2() ? FastInstructions::avx2 : FastInstructions::portable;
}

void expect_agreement(std::string_view kernel, double accuracy, Case const& c, bool with_gradient, std::string const& what) {
  FastParameters const parameters = fast_parameters(kernel, accuracy, with_gradient);
  PointArray const on_host = sum(*make_fast(kernel, parameters, host(), "host"), c, with_gradient);
  PointArray const on_device = sum(*make_fast(kernel, parameters, FastInstructions::device, "device"), c, with_gradient);
  // The host's 1 / |r| is an estimate, with 4 digits in float and 8 in double, or refined once.
  double const bound = parameters.refinement_steps > 0 ? (parameters.single ? 2e-6 : parameters.near_single ? 1e-6 : 1e-13) : parameters.single ? 2e-4 : 1e-7;
  EXPECT_LE(difference(on_device, on_host), bound) << what;
  PointArray const exact = sum(*make_reference(kernel, {}), c, with_gradient);
  EXPECT_LE(difference(on_device, exact), accuracy) << what;
}

}  // namespace

class DeviceSum : public testing::TestWithParam<std::string> {};

TEST_P(DeviceSum, agrees_with_host_loops_and_the_double_loop) {
  for (std::string const distribution : {"sphere", "aster", "line", "clusters"})
    expect_agreement(GetParam(), distribution == "aster" ? 1e-6 : 1e-3, make_case(GetParam(), distribution, 600), false, distribution);
  for (double accuracy : {1e-4, 1e-9})
    expect_agreement(GetParam(), accuracy, make_case(GetParam(), "uniform", 400), false, std::to_string(-std::log10(accuracy)));
}

TEST_P(DeviceSum, has_the_same_gradient) {
  for (double accuracy : {1e-3, 1e-6})
    expect_agreement(GetParam(), accuracy, make_case(GetParam(), "uniform", 400), true, std::to_string(-std::log10(accuracy)));
}

TEST_P(DeviceSum, takes_pairs_that_nearly_touch) {
  expect_agreement(GetParam(), 1e-3, make_case(GetParam(), "nearly touching", 800), false, "");
}

TEST_P(DeviceSum, takes_targets_that_are_not_sources) {
  Case c = make_case(GetParam(), "sphere", 900);
  c.targets.clear();
  for (long i = 0; i < 333; ++i) c.targets.push_back(3.0 * random_vector(i, 9));
  expect_agreement(GetParam(), 1e-6, c, false, "");
}

TEST_P(DeviceSum, follows_points_that_move_and_change_in_number) {
  auto const parameters = fast_parameters(GetParam(), 1e-3);
  auto const device = make_fast(GetParam(), parameters, FastInstructions::device, "device");
  for (long n : {600, 400, 900}) {
    Case const c = make_case(GetParam(), n == 400 ? "aster" : "uniform", n);
    auto const fresh = make_fast(GetParam(), parameters, FastInstructions::device, "device");
    EXPECT_EQ(difference(sum(*device, c, false), sum(*fresh, c, false)), 0.0) << n;
  }
}

INSTANTIATE_TEST_SUITE_P(kernels, DeviceSum,
                         testing::Values("stokeslet", "stresslet", "rotlet", "stokeslet_pressure", "stresslet_pressure"),
                         [](auto const& kernel) { return kernel.param; });

#include "backends/evaluator.hpp"
#include "base/error.hpp"
#include "base/random.hpp"
#include "kernels/list.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace asterflow;

namespace {

Vec3d random_vector(long i, int stream) {
  return {uniform_random(1, i, stream, 0) - 0.5, uniform_random(1, i, stream, 1) - 0.5,
          uniform_random(1, i, stream, 2) - 0.5};
}

Vec3d random_point(std::string const& distribution, long i) {
  Vec3d const p = random_vector(i, 0);
  if (distribution == "sphere") return 7.0 * normalized(p);
  if (distribution == "line") return p.x * Vec3d{3.0, -2.0, 0.5};
  if (distribution == "plane") return {p.x, 2.0 * p.y, 0.0};
  if (distribution == "clusters") return p + Vec3d{i % 2 == 0 ? 0.0 : 1e4, 0.0, 3.0};
  if (distribution == "fibers") return (5.0 + 10.0 * (p.x + 0.5)) * normalized(random_vector(i % 20, 7));
  return p;
}

struct Case {
  PointArray sources, targets, strengths, normals;
};

Case make_case(std::string_view kernel, std::string const& distribution, long n) {
  Case c;
  for (long i = 0; i < n; ++i) {
    c.sources.push_back(random_point(distribution, i));
    c.strengths.push_back(random_vector(i, 1));
    if (kernel == "stresslet") c.normals.push_back(normalized(random_vector(i, 2)));
  }
  c.targets = c.sources;
  return c;
}

PointArray sum(std::string_view kernel, EvaluatorOptions const& options, Case const& c) {
  auto const evaluator = make_evaluator(kernel, options);
  evaluator->set_points(c.sources, c.targets, c.normals);
  PointArray velocity(c.targets.size());
  evaluator->add_velocity(c.strengths, velocity);
  return velocity;
}

// Relative L2 difference from the double loop.
double error(std::string_view kernel, double accuracy, Case const& c) {
  PointArray const fast = sum(kernel, {"fast", accuracy}, c), exact = sum(kernel, {"reference", accuracy}, c);
  return (flat(ConstPoints(fast)) - flat(ConstPoints(exact))).norm() / flat(ConstPoints(exact)).norm();
}

}  // namespace

class FastSum : public testing::TestWithParam<std::string> {};

TEST_P(FastSum, honours_the_accuracy_on_every_distribution) {
  for (std::string const distribution : {"uniform", "sphere", "line", "plane", "clusters", "fibers"})
    for (double accuracy : {1e-3, 1e-7}) {
      Case const c = make_case(GetParam(), distribution, 1200);
      EXPECT_LE(error(GetParam(), accuracy, c), accuracy) << distribution << " " << accuracy;
    }
}

TEST_P(FastSum, reaches_twelve_digits) {
  EXPECT_LE(error(GetParam(), 1e-12, make_case(GetParam(), "uniform", 1000)), 1e-12);
}

TEST_P(FastSum, does_not_depend_on_the_unit_of_length) {
  for (double unit : {1e-8, 1e8}) {
    Case c = make_case(GetParam(), "uniform", 1000);
    for (Vec3d& p : c.sources) p *= unit;
    c.targets = c.sources;
    EXPECT_LE(error(GetParam(), 1e-6, c), 1e-6) << unit;
  }
}

TEST_P(FastSum, takes_targets_that_are_not_sources) {
  Case c = make_case(GetParam(), "sphere", 2000);
  c.targets.clear();
  for (long i = 0; i < 700; ++i) c.targets.push_back(10.0 * random_vector(i, 9));
  EXPECT_LE(error(GetParam(), 1e-6, c), 1e-6);
  c.targets.push_back({300.0, 0.0, 0.0});
  EXPECT_LE(error(GetParam(), 1e-6, c), 1e-6);
}

TEST_P(FastSum, honours_the_accuracy_at_far_targets_alone) {
  for (long n_target : {1, 600}) {
    Case c = make_case(GetParam(), "uniform", 2000);
    c.targets.clear();
    for (long i = 0; i < n_target; ++i) c.targets.push_back(300.0 * normalized(random_vector(i, 9)));
    for (double accuracy : {1e-3, 1e-6}) EXPECT_LE(error(GetParam(), accuracy, c), accuracy) << n_target << " " << accuracy;
  }
}

TEST_P(FastSum, honours_the_accuracy_where_strengths_cancel) {
  // Every source has an opposite one close by: the flow is 1e3 times smaller than that of one sign.
  Case c = make_case(GetParam(), "uniform", 2000);
  for (std::size_t i = 0; i < 1000; ++i) {
    c.sources[2 * i + 1] = c.sources[2 * i] + 1e-3 * random_vector(i, 5);
    c.strengths[2 * i + 1] = -c.strengths[2 * i];
    if (!c.normals.empty()) c.normals[2 * i + 1] = c.normals[2 * i];
  }
  c.targets.clear();
  for (long i = 0; i < 1500; ++i) c.targets.push_back(random_vector(i, 9) + Vec3d{2.0, 0.0, 0.0});
  // The error is judged by a sample of the targets.
  for (double accuracy : {1e-3, 1e-6}) EXPECT_LE(error(GetParam(), accuracy, c), 1.5 * accuracy) << accuracy;
}

TEST_P(FastSum, takes_clusters_far_smaller_than_its_smallest_box) {
  Case c = make_case(GetParam(), "uniform", 2000);
  for (std::size_t i = 0; i < 1000; ++i) c.sources[i] = Vec3d{0.1, 0.2, 0.3} + 1e-9 * c.sources[i];
  c.targets = c.sources;
  for (double accuracy : {1e-3, 1e-6}) EXPECT_LE(error(GetParam(), accuracy, c), accuracy) << accuracy;
}

TEST_P(FastSum, of_one_point_or_many_at_one_place_is_zero) {
  for (long n : {1, 500}) {
    Case c = make_case(GetParam(), "uniform", n);
    c.sources.assign(n, Vec3d{1.0, 2.0, 3.0});
    c.targets = c.sources;
    for (Vec3d const& u : sum(GetParam(), {"fast", 1e-6}, c)) EXPECT_EQ(norm(u), 0.0);
  }
}

TEST_P(FastSum, skips_pairs_of_coincident_points) {
  Case c = make_case(GetParam(), "uniform", 1000);
  for (std::size_t i = 0; i < 500; ++i) c.sources[2 * i] = c.sources[2 * i + 1];
  c.targets = c.sources;
  EXPECT_LE(error(GetParam(), 1e-6, c), 1e-6);
}

TEST_P(FastSum, is_zero_for_zero_strengths) {
  Case c = make_case(GetParam(), "uniform", 1000);
  c.strengths.assign(1000, Vec3d{});
  for (Vec3d const& u : sum(GetParam(), {"fast", 1e-6}, c)) EXPECT_EQ(norm(u), 0.0);
}

TEST_P(FastSum, is_repeatable_to_the_last_bit) {
  Case const c = make_case(GetParam(), "fibers", 2000);
  PointArray const first = sum(GetParam(), {"fast", 1e-6}, c), second = sum(GetParam(), {"fast", 1e-6}, c);
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(norm(first[i] - second[i]), 0.0);
}

TEST_P(FastSum, refuses_points_that_are_not_numbers) {
  Case c = make_case(GetParam(), "uniform", 10);
  for (double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    c.sources[3].y = bad;
    EXPECT_THROW(sum(GetParam(), {"fast", 1e-6}, c), SceneError);
  }
}

TEST_P(FastSum, of_nothing_is_nothing) {
  Case c = make_case(GetParam(), "uniform", 0);
  EXPECT_TRUE(sum(GetParam(), {"fast", 1e-6}, c).empty());
  c.targets.assign(2, Vec3d{});
  for (Vec3d const& u : sum(GetParam(), {"fast", 1e-6}, c)) EXPECT_EQ(norm(u), 0.0);
}

TEST(Automatic_sum, is_direct_for_few_points_and_fast_for_many) {
  auto const evaluator = make_evaluator("stokeslet", {"auto", 1e-3});
  Case const few = make_case("stokeslet", "uniform", 1000), many = make_case("stokeslet", "uniform", 9000);
  evaluator->set_points(few.sources, few.sources);
  EXPECT_NE(evaluator->backend(), "fast");
  evaluator->set_points(many.sources, many.sources);
  EXPECT_EQ(evaluator->backend(), "fast");
}

INSTANTIATE_TEST_SUITE_P(kernels, FastSum, testing::Values("stokeslet", "stresslet", "rotlet"),
                         [](auto const& kernel) { return kernel.param; });

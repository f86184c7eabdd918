#include "backends/evaluator.hpp"
#include "base/error.hpp"
#include "kernels/list.hpp"
#include "point_sets.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace asterflow;

namespace {

PointArray sum(std::string_view kernel, EvaluatorOptions const& options, PointSet const& c) {
  auto const evaluator = make_evaluator(kernel, options);
  evaluator->set_points(c.sources, c.targets, c.normals);
  PointArray velocity(c.targets.size());
  evaluator->add_velocity(c.strengths, velocity);
  return velocity;
}

// Relative L2 difference from the double loop.
double error(std::string_view kernel, double accuracy, PointSet const& c) {
  PointArray const fast = sum(kernel, {"fast", accuracy}, c), exact = sum(kernel, {"reference", accuracy}, c);
  return relative_difference(fast, exact);
}

}  // namespace

class FastSum : public testing::TestWithParam<std::string> {};

TEST_P(FastSum, honours_the_accuracy_on_every_distribution) {
  for (std::string const distribution : {"uniform", "sphere", "line", "plane", "clusters", "fibers"})
    for (double accuracy : {1e-3, 1e-7}) {
      PointSet const c = point_set(GetParam(), distribution, 1200);
      EXPECT_LE(error(GetParam(), accuracy, c), accuracy) << distribution << " " << accuracy;
    }
}

// Pairs of points are then listed once for both directions.
TEST_P(FastSum, honours_the_accuracy_where_targets_are_the_sources) {
  for (std::string const distribution : {"uniform", "clusters", "fibers"})
    for (double accuracy : {1e-3, 1e-6, 1e-9}) {
      PointSet c = point_set(GetParam(), distribution, 1500);
      for (std::size_t i = 0; i < 20; ++i) c.sources[1400 + i] = c.sources[70 * i] + Vec3d{i % 2 == 0 ? 1e-10 : 1.5e-7, 0.0, 0.0};  // beyond float, just within
      PointArray fast(c.sources.size()), exact(c.sources.size());
      for (auto const& [backend, velocity] : {std::pair{"fast", &fast}, std::pair{"reference", &exact}}) {
        auto const evaluator = make_evaluator(GetParam(), {backend, accuracy});
        evaluator->set_points(c.sources, c.sources, c.normals);
        evaluator->add_velocity(c.strengths, *velocity);
      }
      EXPECT_LE(relative_difference(fast, exact), accuracy) << distribution << " " << accuracy;
      // The pairs that nearly touch outweigh all others in that norm.
      double error = 0.0, size = 0.0;
      for (std::size_t i = 0; i < 1400; ++i) {
        if (i % 70 == 0) continue;
        error += dot(fast[i] - exact[i], fast[i] - exact[i]);
        size += dot(exact[i], exact[i]);
      }
      EXPECT_LE(std::sqrt(error / size), 3.0 * accuracy) << distribution << " " << accuracy;
    }
}

TEST_P(FastSum, reaches_twelve_digits) {
  EXPECT_LE(error(GetParam(), 1e-12, point_set(GetParam(), "uniform", 1000)), 1e-12);
}

TEST_P(FastSum, does_not_depend_on_the_unit_of_length) {
  for (double unit : {1e-8, 1e8}) {
    PointSet c = point_set(GetParam(), "uniform", 1000);
    for (Vec3d& p : c.sources) p *= unit;
    c.targets = c.sources;
    EXPECT_LE(error(GetParam(), 1e-6, c), 1e-6) << unit;
  }
}

TEST_P(FastSum, takes_targets_that_are_not_sources) {
  PointSet c = point_set(GetParam(), "sphere", 2000);
  c.targets.clear();
  for (long i = 0; i < 700; ++i) c.targets.push_back(10.0 * random_vector(i, 9));
  EXPECT_LE(error(GetParam(), 1e-6, c), 1e-6);
  c.targets.push_back({300.0, 0.0, 0.0});
  EXPECT_LE(error(GetParam(), 1e-6, c), 1e-6);
}

// A picture of the flow around a few fibers.
TEST_P(FastSum, takes_far_more_targets_than_sources) {
  PointSet c = point_set(GetParam(), "uniform", 60);
  c.targets.clear();
  for (long i = 0; i < 20000; ++i) c.targets.push_back(random_vector(i, 9));
  EXPECT_LE(error(GetParam(), 1e-3, c), 1e-3);
}

TEST_P(FastSum, honours_the_accuracy_at_far_targets_alone) {
  for (long n_target : {1, 600}) {
    PointSet c = point_set(GetParam(), "uniform", 2000);
    c.targets.clear();
    for (long i = 0; i < n_target; ++i) c.targets.push_back(300.0 * normalized(random_vector(i, 9)));
    for (double accuracy : {1e-3, 1e-6}) EXPECT_LE(error(GetParam(), accuracy, c), accuracy) << n_target << " " << accuracy;
  }
}

TEST_P(FastSum, honours_the_accuracy_where_strengths_cancel) {
  // Every source has an opposite one close by: the flow is 1e3 times smaller than that of one sign.
  PointSet c = point_set(GetParam(), "uniform", 2000);
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

TEST_P(FastSum, honours_the_accuracy_of_strengths_of_one_direction_and_of_very_unequal_ones) {
  PointSet c = point_set(GetParam(), "uniform", 2000);
  c.strengths.assign(2000, Vec3d{1.0, 0.5, 0.0});
  EXPECT_LE(error(GetParam(), 1e-6, c), 1e-6);
  for (std::size_t i = 0; i < 2000; ++i) c.strengths[i] = std::pow(10.0, 0.01 * static_cast<double>(i) - 10.0) * random_vector(static_cast<long>(i), 5);
  EXPECT_LE(error(GetParam(), 1e-6, c), 1e-6);
}

TEST_P(FastSum, takes_clusters_far_smaller_than_its_smallest_box) {
  PointSet c = point_set(GetParam(), "uniform", 2000);
  for (std::size_t i = 0; i < 1000; ++i) c.sources[i] = Vec3d{0.1, 0.2, 0.3} + 1e-9 * c.sources[i];
  c.targets = c.sources;
  for (double accuracy : {1e-3, 1e-6}) EXPECT_LE(error(GetParam(), accuracy, c), accuracy) << accuracy;
}

TEST_P(FastSum, of_one_point_or_many_at_one_place_is_zero) {
  for (long n : {1, 500}) {
    PointSet c = point_set(GetParam(), "uniform", n);
    c.sources.assign(n, Vec3d{1.0, 2.0, 3.0});
    c.targets = c.sources;
    for (Vec3d const& u : sum(GetParam(), {"fast", 1e-6}, c)) EXPECT_EQ(norm(u), 0.0);
  }
}

TEST_P(FastSum, skips_pairs_of_coincident_points) {
  PointSet c = point_set(GetParam(), "uniform", 1000);
  for (std::size_t i = 0; i < 500; ++i) c.sources[2 * i] = c.sources[2 * i + 1];
  c.targets = c.sources;
  EXPECT_LE(error(GetParam(), 1e-6, c), 1e-6);
}

TEST_P(FastSum, is_zero_for_zero_strengths) {
  PointSet c = point_set(GetParam(), "uniform", 1000);
  c.strengths.assign(1000, Vec3d{});
  for (Vec3d const& u : sum(GetParam(), {"fast", 1e-6}, c)) EXPECT_EQ(norm(u), 0.0);
}

TEST_P(FastSum, is_repeatable_to_the_last_bit) {
  PointSet const c = point_set(GetParam(), "fibers", 2000);
  PointArray const first = sum(GetParam(), {"fast", 1e-6}, c), second = sum(GetParam(), {"fast", 1e-6}, c);
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(norm(first[i] - second[i]), 0.0);
}

TEST_P(FastSum, does_not_depend_on_where_targets_that_are_the_sources_are_kept) {
  PointSet c = point_set(GetParam(), "fibers", 1500);
  c.targets = c.sources;
  PointArray const apart = sum(GetParam(), {"fast", 1e-6}, c);
  auto const evaluator = make_evaluator(GetParam(), {"fast", 1e-6});
  evaluator->set_points(c.sources, c.sources, c.normals);
  PointArray together(c.sources.size());
  evaluator->add_velocity(c.strengths, together);
  EXPECT_EQ(relative_difference(apart, together), 0.0);
}

TEST_P(FastSum, refuses_points_that_are_not_numbers) {
  PointSet c = point_set(GetParam(), "uniform", 10);
  for (double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    c.sources[3].y = bad;
    EXPECT_THROW(sum(GetParam(), {"fast", 1e-6}, c), SceneError);
  }
}

TEST_P(FastSum, takes_a_target_very_far_away_and_refuses_one_farther) {
  PointSet c = point_set(GetParam(), "uniform", 600);
  c.targets = c.sources;
  c.targets.push_back({1e50, 0.0, 0.0});
  EXPECT_LE(error(GetParam(), 1e-6, c), 1e-6);
  c.targets.back().x = 1e101;
  EXPECT_THROW(sum(GetParam(), {"fast", 1e-6}, c), SceneError);
}

TEST_P(FastSum, of_nothing_is_nothing) {
  PointSet c = point_set(GetParam(), "uniform", 0);
  EXPECT_TRUE(sum(GetParam(), {"fast", 1e-6}, c).empty());
  c.targets.assign(2, Vec3d{});
  for (Vec3d const& u : sum(GetParam(), {"fast", 1e-6}, c)) EXPECT_EQ(norm(u), 0.0);
}

TEST(Automatic_sum, is_direct_for_few_points_and_fast_for_many) {
  auto const evaluator = make_evaluator("stokeslet", {"auto", 1e-3});
  PointSet const few = point_set("stokeslet", "uniform", 200), many = point_set("stokeslet", "uniform", 9000);
  evaluator->set_points(few.sources, few.sources);
  EXPECT_NE(evaluator->backend(), "fast");
  evaluator->set_points(many.sources, many.sources);
  EXPECT_EQ(evaluator->backend(), "fast");
}

// Direct sums are then in double and take twice as long.
TEST(Automatic_sum, is_fast_for_fewer_points_where_two_are_too_close_for_float) {
  auto const evaluator = make_evaluator("stokeslet", {"auto", 1e-3});
  PointSet points = point_set("stokeslet", "uniform", 9000);
  auto const chooses_fast = [&](long n) {
    ConstPoints const some = ConstPoints(points.sources).first(n);
    evaluator->set_points(some, some);
    return evaluator->backend() == "fast";
  };
  long direct = 200, fast = 9000;
  while (fast > direct + 10) (chooses_fast((direct + fast) / 2) ? fast : direct) = (direct + fast) / 2;
  ASSERT_FALSE(chooses_fast(direct));
  points.sources[1] = points.sources[0] + Vec3d{1e-9, 0.0, 0.0};
  EXPECT_TRUE(chooses_fast(direct));
}

INSTANTIATE_TEST_SUITE_P(kernels, FastSum, testing::Values("stokeslet", "stresslet", "rotlet"),
                         [](auto const& kernel) { return kernel.param; });

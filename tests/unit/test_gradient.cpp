// The gradient of the velocity by every backend, against differences of velocities, the reference and
// incompressibility.

#include "backends/evaluator.hpp"
#include "kernels/list.hpp"
#include "point_sets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

using namespace asterflow;

namespace {

PointArray gradient(std::string_view kernel, std::string const& backend, double accuracy, PointSet const& p) {
  auto const evaluator = make_evaluator(kernel, {.backend = backend, .accuracy = accuracy, .gradient = true});
  evaluator->set_points(p.sources, p.targets, p.normals);
  PointArray result(3 * p.targets.size());
  evaluator->add_gradient(p.strengths, result);
  return result;
}

}  // namespace

class Gradient : public testing::TestWithParam<std::string> {};

TEST_P(Gradient, of_the_reference_is_the_limit_of_differences) {
  PointSet p = point_set(GetParam(), 20, 10);
  constexpr double step = 1e-5;
  PointArray differences(3 * p.targets.size());
  for (int axis = 0; axis < 3; ++axis)
    for (double side : {-1.0, 1.0}) {
      PointArray moved = p.targets, velocity(moved.size());
      for (Vec3d& x : moved) x[axis] += side * step;
      auto const reference = make_evaluator(GetParam(), {"reference", 1e-15});
      reference->set_points(p.sources, moved, p.normals);
      reference->add_velocity(p.strengths, velocity);
      for (std::size_t i = 0; i < moved.size(); ++i)
        for (int d = 0; d < 3; ++d) differences[3 * i + d][axis] += side * velocity[i][d] / (2.0 * step);
    }
  // Second order in the step over the distance of the closest pair, some 0.05.
  EXPECT_LE(relative_difference(gradient(GetParam(), "reference", 1e-15, p), differences), 1e-5);
}

TEST_P(Gradient, has_no_trace) {
  PointSet const p = point_set(GetParam(), 900, 300);
  for (auto const& backend : backend_names()) {
    PointArray const g = gradient(GetParam(), backend, 1e-6, p);
    double trace2 = 0.0;
    for (std::size_t i = 0; i < p.targets.size(); ++i) {
      double const trace = g[3 * i].x + g[3 * i + 1].y + g[3 * i + 2].z;
      trace2 += trace * trace;
    }
    EXPECT_LE(std::sqrt(trace2), 3e-6 * flat(ConstPoints(g)).norm()) << backend;
  }
}

TEST_P(Gradient, honours_the_accuracy_with_every_backend) {
  PointSet p = point_set(GetParam(), 1000, 700);
  for (bool is_self : {false, true}) {
    if (is_self) p.targets = p.sources;
    PointArray const exact = gradient(GetParam(), "reference", 1e-15, p);
    for (auto const& backend : backend_names())
      for (double accuracy : {1e-3, 1e-6, 1e-9})
        EXPECT_LE(relative_difference(gradient(GetParam(), backend, accuracy, p), exact), accuracy)
            << backend << " at " << accuracy << (is_self ? " self" : "");
  }
}

TEST_P(Gradient, skips_coincident_points) {
  PointSet p = point_set(GetParam(), 1000, 0);
  for (std::size_t i = 0; i < 500; ++i) p.sources[2 * i] = p.sources[2 * i + 1];
  p.targets = p.sources;
  PointArray const exact = gradient(GetParam(), "reference", 1e-15, p);
  for (auto const& backend : backend_names())
    for (double accuracy : {1e-3, 1e-6})
      EXPECT_LE(relative_difference(gradient(GetParam(), backend, accuracy, p), exact), accuracy) << backend;
}

TEST_P(Gradient, of_the_fast_sum_honours_the_accuracy_where_velocities_cancel_or_targets_are_far) {
  PointSet p = point_set(GetParam(), 2000, 1500);
  for (std::size_t i = 0; i < 1000; ++i) {
    p.sources[2 * i + 1] = p.sources[2 * i] + 1e-3 * random_vector(static_cast<long>(i), 5);
    p.strengths[2 * i + 1] = -p.strengths[2 * i];
    if (!p.normals.empty()) p.normals[2 * i + 1] = p.normals[2 * i];
  }
  for (double distance : {2.0, 200.0}) {
    for (std::size_t i = 0; i < p.targets.size(); ++i)
      p.targets[i] = distance * (random_vector(static_cast<long>(i), 9) + Vec3d{1.0, 0.0, 0.0});
    PointArray const exact = gradient(GetParam(), "reference", 1e-15, p);
    for (double accuracy : {1e-3, 1e-6})
      // The error is judged by a sample of the targets.
      EXPECT_LE(relative_difference(gradient(GetParam(), "fast", accuracy, p), exact), 2.0 * accuracy)
          << distance << " " << accuracy;
  }
}

TEST_P(Gradient, of_the_fast_sum_honours_the_accuracy_without_the_few_largest_too) {
  for (long n_source : {1, 2, 200}) {
    PointSet const p = point_set(GetParam(), n_source, 4000);
    PointArray exact = gradient(GetParam(), "reference", 1e-15, p);
    std::vector<double> sizes(p.targets.size());
    for (std::size_t i = 0; i < sizes.size(); ++i)
      for (int d = 0; d < 3; ++d) sizes[i] += dot(exact[3 * i + d], exact[3 * i + d]);
    std::vector<double> sorted = sizes;
    std::nth_element(sorted.begin(), sorted.begin() + 100, sorted.end(), std::greater<>());
    for (double accuracy : {1e-4, 1e-6}) {
      PointArray some = gradient(GetParam(), "fast", accuracy, p), exact_some = exact;
      for (std::size_t i = 0; i < some.size(); ++i)
        if (sizes[i / 3] > sorted[100]) some[i] = exact_some[i] = {};
      EXPECT_LE(relative_difference(some, exact_some), accuracy) << n_source;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(kernels, Gradient, testing::Values("stokeslet", "stresslet", "rotlet"),
                         [](auto const& kernel) { return kernel.param; });

// Pressures: of the kernels, against the Stokes equation; of every backend, against the reference.

#include "backends/evaluator.hpp"
#include "kernels/list.hpp"
#include "point_sets.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace asterflow;

namespace {

// Laplacian of the velocity minus gradient of the pressure at r, by differences of fourth order.
template <class Flow, class Pressure>
Vec3d residual(Vec3d r, Vec3d q, Vec3d n) {
  constexpr double h = 3e-3;
  Vec3d sum{};
  for (int d = 0; d < 3; ++d)
    for (int k = -2; k <= 2; ++k) {
      constexpr double second[] = {-1.0 / 12, 4.0 / 3, -5.0 / 2, 4.0 / 3, -1.0 / 12};
      constexpr double first[] = {1.0 / 12, -2.0 / 3, 0.0, 2.0 / 3, -1.0 / 12};
      Vec3d moved = r;
      moved[d] += k * h;
      sum += second[k + 2] / (h * h) * Flow::velocity(moved, q, n);
      sum[d] -= first[k + 2] / h * Pressure::velocity(moved, q, n).x;
    }
  return sum;
}

PointArray pressure(std::string_view kernel, std::string const& backend, double accuracy, PointSet const& p) {
  auto const evaluator = make_evaluator(kernel, {backend, accuracy});
  evaluator->set_points(p.sources, p.targets, p.normals);
  PointArray result(p.targets.size());
  evaluator->add_velocity(p.strengths, result);
  return result;
}

}  // namespace

class Pressure : public testing::TestWithParam<std::string> {};

TEST(Pressures, balance_the_viscous_force) {
  for (int i = 0; i < 5; ++i) {
    Vec3d const r = normalized(random_vector(i, 0)), q = random_vector(i, 1), n = normalized(random_vector(i, 2));
    // Fourth order in the step over the distance, with some 100 as a factor.
    EXPECT_LE(norm(residual<Stokeslet, StokesletPressure>(r, q, n)), 1e-8);
    EXPECT_LE(norm(residual<Stresslet, StressletPressure>(r, q, n)), 1e-7);
  }
}

TEST_P(Pressure, honours_the_accuracy_with_every_backend) {
  PointSet p = point_set(GetParam(), 2000, 1500);
  for (bool is_self : {false, true}) {
    if (is_self) p.targets = p.sources;
    PointArray const exact = pressure(GetParam(), "reference", 1e-15, p);
    for (auto const& backend : backend_names())
      for (double accuracy : {1e-3, 1e-6, 1e-9})
        EXPECT_LE(relative_difference(pressure(GetParam(), backend, accuracy, p), exact), accuracy)
            << backend << " at " << accuracy << (is_self ? " self" : "");
  }
}

TEST_P(Pressure, skips_coincident_points_and_does_not_depend_on_the_unit_of_length) {
  PointSet p = point_set(GetParam(), 2000, 0);
  for (std::size_t i = 0; i < 1000; ++i) p.sources[2 * i] = p.sources[2 * i + 1];
  for (double unit : {1.0, 1e-8, 1e8}) {
    PointSet scaled = p;
    for (Vec3d& x : scaled.sources) x *= unit;
    scaled.targets = scaled.sources;
    PointArray const exact = pressure(GetParam(), "reference", 1e-15, scaled);
    for (auto const& backend : backend_names())
      for (double accuracy : {1e-3, 1e-6})
        EXPECT_LE(relative_difference(pressure(GetParam(), backend, accuracy, scaled), exact), accuracy) << backend << unit;
  }
}

TEST_P(Pressure, of_the_fast_sum_honours_the_accuracy_far_away) {
  PointSet p = point_set(GetParam(), 2000, 400);
  for (Vec3d& x : p.targets) x = 300.0 * normalized(x);
  PointArray const exact = pressure(GetParam(), "reference", 1e-15, p);
  for (double accuracy : {1e-3, 1e-6})
    EXPECT_LE(relative_difference(pressure(GetParam(), "fast", accuracy, p), exact), accuracy) << accuracy;
}

INSTANTIATE_TEST_SUITE_P(kernels, Pressure, testing::Values("stokeslet_pressure", "stresslet_pressure"),
                         [](auto const& kernel) { return kernel.param; });

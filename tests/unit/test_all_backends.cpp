// Every backend of this build, for every kernel and accuracy, against the reference.

#include "backends/evaluator.hpp"
#include "base/error.hpp"
#include "base/random.hpp"
#include "kernels/list.hpp"

#include <algorithm>
#include <gtest/gtest.h>

#include <limits>

using namespace asterflow;

namespace {

constexpr double accuracies[] = {1e-3, 1e-4, 1e-6, 1e-7, 1e-9, 1e-12, 1e-15};

// Both sums round: a few hundred terms of random sign leave some 1e-15.
constexpr double rounding = 4e-15;

// Uniform in the cube of edge 2 `size` around `centre`.
PointArray random_points(std::size_t n, std::uint64_t seed, double size = 1.0, Vec3d centre = {}) {
  PointArray points(n);
  for (std::size_t i = 0; i < n; ++i)
    for (int c = 0; c < 3; ++c) points[i][c] = centre[c] + size * (2.0 * uniform_random(seed, i, 0, c) - 1.0);
  return points;
}

PointArray random_normals(std::size_t n, std::uint64_t seed) {
  PointArray normals = random_points(n, seed);
  for (auto& normal : normals) normal = normalized(normal);
  return normals;
}

std::vector<std::string> kernels() {
  std::vector<std::string> names;
  std::apply([&](auto... kernel) { (names.emplace_back(kernel.name), ...); }, AllKernels{});
  return names;
}

struct Problem {
  PointArray sources, targets, strengths;

  PointArray velocity(std::string const& backend, std::string const& kernel, double accuracy) const {
    auto const evaluator = make_evaluator(kernel, {.backend = backend, .accuracy = accuracy});
    PointArray const normals = kernel == "stresslet" ? random_normals(sources.size(), 99) : PointArray{};
    evaluator->set_points(sources, targets, normals);
    PointArray u(targets.size());
    evaluator->add_velocity(strengths, u);
    return u;
  }
};

Problem random_problem(std::size_t n_source, std::size_t n_target, double size = 1.0, Vec3d centre = {}) {
  return {random_points(n_source, 1, size, centre), random_points(n_target, 2, size, centre), random_points(n_source, 3)};
}

Problem self_problem(std::size_t n, double size = 1.0, Vec3d centre = {}) {
  Problem p = random_problem(n, 0, size, centre);
  p.targets = p.sources;
  return p;
}

double difference(PointArray const& u, PointArray const& exact) {
  double error = 0.0, norm = 0.0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    Vec3d const e = u[i] - exact[i];
    error += dot(e, e);
    norm += dot(exact[i], exact[i]);
  }
  return error == 0.0 ? 0.0 : std::sqrt(error / norm);  // NaN counts as wrong in EXPECT_LE
}

void expect_agreement(Problem const& problem, std::string const& what) {
  for (auto const& kernel : kernels()) {
    auto const exact = problem.velocity("reference", kernel, 1e-15);
    for (auto const& backend : backend_names())
      for (double const accuracy : accuracies)
        EXPECT_LE(difference(problem.velocity(backend, kernel, accuracy), exact), std::max(accuracy, rounding))
            << what << ": " << backend << " " << kernel << " at " << accuracy;
  }
}

}  // namespace

TEST(All_backends, agree_with_the_reference_for_separate_sources_and_targets) {
  expect_agreement(random_problem(700, 300), "separate");
}

TEST(All_backends, agree_with_the_reference_for_self_sums) { expect_agreement(self_problem(1000), "self"); }

TEST(All_backends, agree_with_the_reference_when_the_sources_are_some_of_the_targets) {
  Problem p = random_problem(600, 50);
  p.targets.insert(p.targets.begin() + 20, p.sources.begin(), p.sources.end());
  expect_agreement(p, "run");
}

TEST(All_backends, agree_with_the_reference_for_any_number_of_points) {
  for (std::size_t const n_source : {0, 1, 7, 8, 9, 17})
    for (std::size_t const n_target : {0, 1, 7, 8, 9, 33})
      expect_agreement(random_problem(n_source, n_target), std::to_string(n_source) + " x " + std::to_string(n_target));
  for (std::size_t const n : {1, 2, 8, 9, 255, 257}) expect_agreement(self_problem(n), "self " + std::to_string(n));
}

TEST(All_backends, agree_with_the_reference_far_from_the_origin) {
  // 1e5 extents away: coordinates keep eleven digits of the cloud, the same ones for every backend.
  expect_agreement(self_problem(300, 1.0, {1e5, -1e5, 2e5}), "far self");
  expect_agreement(random_problem(100, 100, 1.0, {1e5, -1e5, 2e5}), "far");
}

TEST(All_backends, agree_with_the_reference_in_any_unit_of_length) {
  for (double const size : {1e-8, 1e8}) {
    expect_agreement(self_problem(300, size), "size " + std::to_string(size));
    expect_agreement(random_problem(60, 60, size, {size, 0.0, 0.0}), "size " + std::to_string(size));
  }
}

TEST(All_backends, keep_the_accuracy_of_pairs_much_closer_than_the_extent) {
  for (double const distance : {1e-5, 1e-8, 1e-11}) {
    Problem p = self_problem(300);
    for (std::size_t i = 0; i < 100; ++i) p.sources[2 * i] = p.sources[2 * i + 1] + distance * p.sources[200 + i];
    p.targets = p.sources;
    expect_agreement(p, "distance " + std::to_string(distance));
  }
}

TEST(All_backends, agree_with_the_reference_for_two_far_clusters_and_for_a_line) {
  Problem clusters = self_problem(300, 1e-3);
  for (std::size_t i = 0; i < 150; ++i) clusters.sources[i] += Vec3d{1e3, 2e3, -1e3};
  clusters.targets = clusters.sources;
  expect_agreement(clusters, "clusters");
  Problem line = self_problem(300);
  for (auto& x : line.sources) x.y = x.z = 0.25;
  line.targets = line.sources;
  expect_agreement(line, "line");
}

TEST(All_backends, take_strengths_of_any_size) {
  for (double const size : {1e-60, 1e60}) {
    Problem p = self_problem(300);
    for (auto& q : p.strengths) q *= size;
    expect_agreement(p, "strength " + std::to_string(size));
  }
}

TEST(All_backends, take_strengths_too_small_for_all_their_digits) {
  for (double const size : {1e-310, 5e-324}) {
    Problem p = self_problem(300);
    for (auto& q : p.strengths) q *= size;
    for (auto const& backend : backend_names())
      for (auto const& kernel : kernels())
        for (double const accuracy : accuracies) {
          PointArray const u = p.velocity(backend, kernel, accuracy);
          EXPECT_TRUE(std::all_of(u.begin(), u.end(), [](Vec3d v) { return norm(v) < 1e-300; }))
              << backend << " " << kernel << " at " << accuracy << ", strengths of " << size;
        }
  }
}

TEST(All_backends, give_exactly_zero_between_coincident_points) {
  Problem p = self_problem(300);
  for (auto& x : p.sources) x = {0.1, 0.2, 0.3};
  p.targets = {{0.1, 0.2, 0.3}, {0.1, 0.2, 0.3}};
  Problem self = p;
  self.targets = self.sources;
  for (auto const& kernel : kernels())
    for (auto const& backend : backend_names())
      for (double const accuracy : accuracies)
        for (Problem const* problem : {&p, &self})
          for (Vec3d const& u : problem->velocity(backend, kernel, accuracy))
            EXPECT_TRUE(u.x == 0.0 && u.y == 0.0 && u.z == 0.0) << backend << " " << kernel << " at " << accuracy;
}

TEST(All_backends, count_coincident_sources_at_other_targets) {
  Problem p = self_problem(300);
  for (std::size_t i = 0; i < 100; ++i) p.sources[i] = p.sources[200 + i / 2];
  p.targets = p.sources;
  expect_agreement(p, "coincident");
}

TEST(All_backends, add_to_what_the_velocity_holds) {
  Problem const p = random_problem(20, 10);
  for (auto const& backend : backend_names()) {
    auto const evaluator = make_evaluator("stokeslet", {.backend = backend, .accuracy = 1e-12});
    evaluator->set_points(p.sources, p.targets);
    PointArray u(10), twice(10);
    evaluator->add_velocity(p.strengths, u);
    for (int k = 0; k < 2; ++k) evaluator->add_velocity(p.strengths, twice);
    for (std::size_t i = 0; i < u.size(); ++i) EXPECT_DOUBLE_EQ(twice[i].x, 2.0 * u[i].x) << backend;
  }
}

TEST(All_backends, give_the_same_bits_for_the_same_points) {
  Problem const p = self_problem(700);
  for (auto const& kernel : kernels())
    for (auto const& backend : backend_names())
      for (double const accuracy : {1e-3, 1e-6, 1e-12})
        EXPECT_EQ(difference(p.velocity(backend, kernel, accuracy), p.velocity(backend, kernel, accuracy)), 0.0)
            << backend << " " << kernel;
}

TEST(All_backends, follow_points_that_move_and_change_in_number) {
  for (auto const& backend : backend_names()) {
    auto const evaluator = make_evaluator("stokeslet", {.backend = backend, .accuracy = 1e-6});
    for (std::size_t const n : {600, 30, 900, 1}) {
      Problem const p = self_problem(n, 1.0 + n);
      evaluator->set_points(p.sources, p.targets);
      PointArray u(n);
      evaluator->add_velocity(p.strengths, u);
      EXPECT_LE(difference(u, p.velocity("reference", "stokeslet", 1e-6)), 1e-6) << backend << " " << n;
    }
  }
}

TEST(All_backends, keep_the_accuracy_at_few_targets_where_velocities_cancel) {
  Problem p = random_problem(2000, 1);
  for (std::uint64_t seed = 10; seed < 50; ++seed) {
    p.targets = random_points(1, seed);
    for (auto const& kernel : kernels())
      EXPECT_LE(difference(p.velocity("direct", kernel, 1e-6), p.velocity("reference", kernel, 1e-15)), 1e-6) << kernel << seed;
  }
}

TEST(All_backends, keep_the_accuracy_between_sources_that_a_far_target_dwarfs) {
  for (std::size_t n_source : {1, 3, 600})
    for (double far : {1e25, 1e99}) {
      Problem p = random_problem(n_source, 5);
      Problem with_far = p;
      with_far.targets.push_back({far, 0.0, -far});
      for (auto const& kernel : kernels()) {
        auto const exact = p.velocity("reference", kernel, 1e-15);
        for (auto const& backend : backend_names()) {
          auto velocity = with_far.velocity(backend, kernel, 1e-6);
          EXPECT_LT(norm(velocity.back()), 1e-22) << backend << " " << kernel;  // 600 strengths of size 1
          velocity.pop_back();
          EXPECT_LE(difference(velocity, exact), 1e-6) << backend << " " << kernel << " " << far << " " << n_source;
        }
      }
    }
}

TEST(All_backends, refuse_coordinates_that_are_not_finite) {
  for (double const bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    for (auto const& backend : backend_names()) {
      auto const evaluator = make_evaluator("stokeslet", {.backend = backend});
      PointArray const points{{0.0, 0.0, 0.0}, {1.0, bad, 0.0}};
      EXPECT_THROW(evaluator->set_points(points, points), SceneError) << backend;
    }
}

TEST(Make_evaluator, names_what_it_knows_when_asked_for_something_else) {
  EXPECT_THROW(make_evaluator("stoklet", {}), SceneError);
  EXPECT_THROW(make_evaluator("stokeslet", {.backend = "fats"}), SceneError);
  EXPECT_THROW(make_evaluator("stokeslet", {.accuracy = 0.0}), SceneError);
}

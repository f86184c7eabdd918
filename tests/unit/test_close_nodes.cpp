#include "system/close_nodes.hpp"

#include "base/random.hpp"
#include "kernels/stokeslet.hpp"
#include "system/simulation.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

using namespace asterflow;

namespace {

// Stokeslet and correction of a unit force along (1, 2, 2) / 3 at the origin, at a node of another fiber.
Vec3d flow_at(Vec3d x, double weight) {
  PointArray const nodes{{}, x}, strengths{{1.0 / 3, 2.0 / 3, 2.0 / 3}, {}};
  std::vector<double> const weights{weight, weight};
  CloseNodes close;
  close.find(nodes, weights, {0, 1, 2});
  PointArray velocity(2);
  close.add_correction(strengths, velocity);
  return Stokeslet::velocity(x, strengths[0]) + velocity[1];
}

PointArray cloud(std::size_t n) {
  PointArray points;
  for (std::uint64_t i = 0; i < n; ++i)
    points.push_back({uniform_random(1, 0, i, 0), uniform_random(1, 0, i, 1), uniform_random(1, 0, i, 2)});
  return points;
}

}  // namespace

TEST(CloseNodes, Flow_and_its_slope_are_continuous_where_the_stokeslet_is_joined) {
  double const weight = 0.8, step = 1e-6;
  Vec3d const direction{0.6, 0.0, -0.8};
  for (double const join : {0.6 * weight, 0.75 * weight}) {  // where spheres of 0.3 w touch; where they become points
    Vec3d const in = flow_at((join - step) * direction, weight), at = flow_at(join * direction, weight),
                out = flow_at((join + step) * direction, weight);
    EXPECT_LT(norm(in - at), 2 * norm(out - at) + 1e-15);
    EXPECT_LT(norm((in + out) - 2.0 * at), 1e-3 * norm(out - in));
  }
}

TEST(CloseNodes, Flow_is_bounded_and_along_the_force_where_two_nodes_coincide) {
  Vec3d const f{1.0 / 3, 2.0 / 3, 2.0 / 3};
  for (double const x : {0.0, 1e-9, 1e-6}) {
    double const cancelled = x > 0.0 ? Stokeslet::prefactor / x : 0.0;  // two flows of this size, rounded
    EXPECT_LT(norm(flow_at({x, 0, 0}, 0.8) - (Stokeslet::prefactor * 4.0 / (3.0 * 0.24)) * f), 1e-6 + 4e-16 * cancelled);  // falls linearly in x
  }
}

TEST(CloseNodes, All_close_pairs_of_different_fibers_are_found_and_no_others) {
  PointArray nodes = cloud(700);
  for (Vec3d& x : nodes) x = 5.0 * x - Vec3d{2.0, 3.0, 1.0};
  std::vector<double> weights;
  std::vector<std::size_t> first{0};
  for (std::size_t i = 0; i < nodes.size(); ++i) weights.push_back(0.5 + uniform_random(1, 1, i, 0));
  while (first.back() < nodes.size()) first.push_back(first.back() + 10);
  std::size_t expected = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (std::size_t j = 0; j < nodes.size(); ++j)
      expected += i / 10 != j / 10 && norm(nodes[i] - nodes[j]) < 0.375 * (weights[i] + weights[j]);
  CloseNodes close;
  close.find(nodes, weights, first);
  EXPECT_GT(expected, 100u);
  EXPECT_EQ(close.count(), expected);
}

TEST(CloseNodes, Overlapping_nodes_yield_to_all_forces) {
  PointArray nodes = cloud(40);  // each a fiber, all within the spheres of all others
  std::vector<double> weights;
  std::vector<std::size_t> first{0};
  for (std::size_t i = 0; i < nodes.size(); ++i) weights.push_back(3.0 + uniform_random(1, 1, i, 0)), first.push_back(i + 1);
  CloseNodes close;
  close.find(nodes, weights, first);
  Eigen::MatrixXd mobility(120, 120);
  for (std::size_t j = 0; j < 40; ++j)
    for (int k = 0; k < 3; ++k) {
      PointArray strengths(40), velocity(40);
      strengths[j][k] = 1.0;
      for (std::size_t i = 0; i < 40; ++i) velocity[i] = Stokeslet::velocity(nodes[i] - nodes[j], strengths[j]);
      close.add_correction(strengths, velocity);
      velocity[j][k] = Stokeslet::prefactor * 4.0 / (3.0 * 0.3 * weights[j]);  // of a sphere by itself: less than of a fiber
      mobility.col(static_cast<long>(3 * j) + k) = flat(ConstPoints(velocity));
    }
  EXPECT_LT((mobility - mobility.transpose()).norm(), 1e-12);
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(mobility).eigenvalues()[0], 0.0);
}

TEST(CloseNodes, A_narrow_bundle_from_one_point_is_solved) {
  Simulation simulation(parse_scene(R"(
    [[aster]]
    centrosome_radius = 0.0
    opening = 10.0
    count = 15
    arrangement = "even"
    minus_end = "hinged"
    length = 2.5
    nodes = 10
    [background]
    shear_rate = 1.0
    [run]
    interactions = "open"
    accuracy = 1e-3
  )", "bundle.toml"));
  EXPECT_LT(simulation.step(0.01).iterations, 30);
}

TEST(CloseNodes, Fibers_pushed_through_each_other_cross) {
  auto const scene = parse_scene(R"(
    [[fiber]]
    position = [0.0, 0.0, 0.0]
    direction = [1.0, 0.0, 0.0]
    length = 2.0
    nodes = 8
    force_density = [0.0, 0.0, 1.0]
    [[fiber]]
    position = [1.0, -1.0, 0.05]
    direction = [0.0, 1.0, 0.0]
    length = 2.0
    nodes = 8
    force_density = [0.0, 0.0, -1.0]
    [run]
    interactions = "open"
    accuracy = 1e-3
  )", "crossing.toml");
  Simulation simulation(scene);
  int steps = 0;
  while (simulation.time() < 1.0 && steps < 300) simulation.step(1.0), ++steps;
  EXPECT_LT(steps, 300);
  EXPECT_GT(simulation.fibers().shape(0).minus_end.z, simulation.fibers().shape(1).minus_end.z + 0.1);
}

// Orders in time and space of one fiber in a flow that bends it strongly.
#include "fiber_fixture.hpp"

#include <gtest/gtest.h>

using namespace asterflow;
using namespace asterflow::test;

namespace {

Vec3d bending_flow(Vec3d x) {
  return {0.6 * x.y + 0.1 * x.x, -0.1 * x.y + 0.05 * std::sin(0.5 * x.x), 0.1 * std::cos(0.4 * x.x)};
}

// A fiber that starts straight and grows or shrinks, after 4 s.
Centreline run(MinusEnd minus_end, double growth_speed, int n_node, int n_step) {
  Fibers fibers(1.0);
  Centreline const start = straight_centreline({}, {1, 0.3, 0.1}, 10.0, n_node);
  fibers.add({.bending_rigidity = 1.0, .n_node = n_node}, {.kind = minus_end, .direction = start.tangents[0]}, start);
  double const dt = 4.0 / n_step;
  double time = 0.0;
  auto const advance = [&](double h) {
    fibers.begin_step();
    time += h;
    fibers.plan(0).length = 10.0 + growth_speed * time;
    step(fibers, h, bending_flow);
  };
  // The first step, in pieces that double: its first piece is of first order.
  double piece = std::ldexp(dt, -12);
  advance(piece);
  for (; piece < dt; piece *= 2) advance(std::min(piece, dt - time));
  for (int i = 1; i < n_step; ++i) advance(dt);
  return fibers.shape(0);
}

double distance(Centreline const& a, Centreline const& b) {
  std::vector<double> s;
  for (int i = 0; i <= 20; ++i) s.push_back(std::min(a.length, b.length) * i / 20);
  PointArray x(21), y(21);
  sample(a, s, x, {});
  sample(b, s, y, {});
  double largest = 0.0;
  for (int i = 0; i <= 20; ++i) largest = std::max(largest, norm(x[i] - y[i]));
  return largest;
}

}  // namespace

class FiberConvergence : public testing::TestWithParam<std::tuple<MinusEnd, double>> {};

TEST_P(FiberConvergence, is_of_second_order_in_time) {
  auto const [minus_end, growth_speed] = GetParam();
  Centreline const a = run(minus_end, growth_speed, 12, 80), b = run(minus_end, growth_speed, 12, 160),
                   c = run(minus_end, growth_speed, 12, 320);
  double const order = std::log2(distance(a, b) / distance(b, c));
  EXPECT_GT(order, 1.8);
  EXPECT_LT(distance(b, c), 1e-3);
}

TEST_P(FiberConvergence, is_spectral_in_space) {
  auto const [minus_end, growth_speed] = GetParam();
  Centreline const exact = run(minus_end, growth_speed, 40, 60);
  double const coarse = distance(run(minus_end, growth_speed, 8, 60), exact);
  double const medium = distance(run(minus_end, growth_speed, 16, 60), exact);
  double const fine = distance(run(minus_end, growth_speed, 32, 60), exact);
  EXPECT_LT(coarse, 0.1);
  EXPECT_LT(medium, 0.03 * coarse);  // digits grow with the node count
  EXPECT_LT(fine, std::max(1e-3 * medium, 1e-8));
}

INSTANTIATE_TEST_SUITE_P(ends_and_growth, FiberConvergence,
                         testing::Combine(testing::Values(MinusEnd::free, MinusEnd::hinged, MinusEnd::clamped),
                                          testing::Values(0.0, 0.3, -0.3)));

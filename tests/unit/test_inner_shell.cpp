// Flows of sources behind a wall, continued inwards from a copy of it.

#include "kernels/stokeslet.hpp"
#include "surface/inner_shell.hpp"

#include <gtest/gtest.h>

using namespace asterflow;

namespace {

ShapeSpec ellipsoid(Vec3d semi_axes) {
  return {.kind = ShapeSpec::Kind::ellipsoid, .semi_axes = {semi_axes.x, semi_axes.y, semi_axes.z}};
}

// Flow of forces half a micron behind the wall.
PointArray flow(Surface const& wall, ConstPoints points) {
  PointArray u(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t node = 3; node < wall.size(); node += 41)
      u[i] += Stokeslet::velocity(points[i] - (wall.nodes()[node] + 0.5 * wall.normals()[node]),
                                  {std::cos(1.0 * node), std::sin(1.3 * node), std::sin(2.0 + node)});
  return u;
}

void check(ShapeSpec const& spec, double accuracy, bool is_rough) {
  auto const shape = make_shape(spec);
  auto const interior = std::make_shared<DirichletFlow const>(
      Surface(shape, grid_of_order(*shape, default_order(*shape, accuracy))), Side::interior, 0.1 * accuracy);
  InnerShell shell(interior, is_rough, accuracy);
  ASSERT_GT(shell.scale(), 0.44);
  PointArray targets;
  for (int i = 0; i < 200; ++i) {
    double const z = -1.0 + (2 * i + 1) / 200.0, rho = 0.1 + 0.9 * std::fmod(0.618 * i, 1.0), s = std::sqrt(1.0 - z * z);
    Vec3d const on_wall = shape->image({s * std::cos(2.4 * i), s * std::sin(2.4 * i), z}).position;
    targets.push_back(shape->centre() + rho * (on_wall - shape->centre()));
  }
  shell.plan(interior->plan(targets));
  ASSERT_GT(shell.inside().size(), 40u);
  ASSERT_LT(shell.inside().size(), 190u);
  PointArray u(targets.size());
  shell.add_velocity(flow(interior->surface(), shell.nodes()), u);
  PointArray const expected = flow(interior->surface(), targets);
  double error = 0.0, size = 0.0;
  std::vector<bool> is_inside(targets.size());
  for (std::size_t const i : shell.inside()) {
    is_inside[i] = true;
    EXPECT_LT(interior->surface().shape().shell_point(targets[i]).rho, shell.scale() + 1e-12);
    error += dot(u[i] - expected[i], u[i] - expected[i]);
    size += dot(expected[i], expected[i]);
  }
  EXPECT_LT(std::sqrt(error / size), accuracy);
  for (std::size_t i = 0; i < targets.size(); ++i) {
    if (is_inside[i]) continue;
    EXPECT_EQ(norm(u[i]), 0.0);
  }
}

}  // namespace

TEST(InnerShell, ContinuesFlowsInEllipsoids) {
  check(ellipsoid({25, 15, 15}), 1e-3, true);
  check(ellipsoid({25, 15, 15}), 1e-4, false);
  check(ellipsoid({9, 16, 16}), 1e-3, true);
}

TEST(InnerShell, ContinuesFlowsInASphere) {
  check(ellipsoid({12, 12, 12}), 1e-5, false);
}

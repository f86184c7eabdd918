// What the nodes of a cortex take of forces close to it. The exact answer comes from reciprocity: g . u(x) of a force f at y is
// f . u(y) of a force g at x, and the flow of a force far from the cortex is resolved everywhere, close to the cortex too.

#include "surface/screened_forces.hpp"

#include "system/radiation.hpp"

#include <gtest/gtest.h>

using namespace asterflow;

namespace {

constexpr double viscosity = 1.7;

struct Cell {
  Radiation::Flow flow;
  std::shared_ptr<ScreenedForces const> screened;
};

Cell make_cell(ShapeSpec const& spec, int order) {
  auto const flow = std::make_shared<DirichletFlow const>(Surface(make_shape(spec), order), Side::interior, 1e-8);
  return {flow, make_screened_forces(flow->surface(), image_reach(flow->surface(), Side::interior), 1e-6)};
}

ShapeSpec ellipsoid(Vec3d semi_axes) {
  ShapeSpec spec;
  spec.kind = ShapeSpec::Kind::ellipsoid;
  spec.semi_axes = semi_axes;
  return spec;
}

Vec3d velocity(Cell const& cell, Vec3d x, Vec3d y, Vec3d f) {
  Radiation radiation({}, cell.flow, {.viscosity = viscosity, .evaluator = "direct", .accuracy = 1e-12,
                                      .near_periphery = cell.screened});
  PointArray const source{y}, density{f}, target{x};
  std::vector<double> const weights{1.0};
  std::vector<std::size_t> const first{0, 1};
  radiation.set_geometry({source, weights, &first}, {});
  PointArray received(radiation.nodes().size()), nothing(radiation.nodes().size()), u(1);
  radiation.exchange(density, {}, {}, nothing, received);
  radiation.add_velocity(density, {}, received, target, u);
  return u[0];
}

// Largest error of the flow at x, relative to that of the same force without a cell.
double distant_error(Cell const& cell, Vec3d x, double distance) {
  double worst = 0.0;
  for (Vec3d const direction : {Vec3d{0.4, 0.7, 0.35}, Vec3d{0, 0.2, -1}, Vec3d{1, 0.01, 0}}) {
    Vec3d const wall = cell.flow->surface().shape().image(normalized(direction)).position;
    Vec3d const n = cell.flow->surface().shape().closest_point(wall).normal, y = wall - distance * n;
    for (Vec3d const f : {n, normalized(cross(n, Vec3d{0.3, 1, 0.2}))}) {
      Vec3d const u = velocity(cell, x, y, f);
      for (int k = 0; k < 3; ++k) {
        Vec3d g;
        g[k] = 1.0;
        worst = std::max(worst, std::abs(u[k] - dot(f, velocity(cell, y, x, g))) * 8 * M_PI * viscosity * norm(x - y));
      }
    }
  }
  return worst;
}

}  // namespace

// The exact answer is right to 2e-5 here. The last force counts as one at 1e-3 of the length that it stands for.
TEST(ScreenedForces, act_far_away_as_they_should_from_any_distance_to_an_ellipsoid) {
  Cell const cell = make_cell(ellipsoid({25, 15, 15}), 20);
  for (double const distance : {0.02, 0.1}) EXPECT_LT(distant_error(cell, {-3, -1, 1}, distance), 5e-5) << distance;
  EXPECT_LT(distant_error(cell, {-3, -1, 1}, 0.0), 5e-4);
}

TEST(ScreenedForces, act_far_away_as_they_should_in_a_flat_cell_with_its_axis_along_z) {
  Cell const cell = make_cell(ellipsoid({15, 15, 12}), 16);
  EXPECT_LT(distant_error(cell, {-2, -2, 1}, 0.1), 2e-5);
}

TEST(ScreenedForces, act_far_away_as_they_should_in_a_pear) {
  ShapeSpec spec;
  spec.kind = ShapeSpec::Kind::revolution;
  spec.profile = {{-9, 0}, {-8, 5}, {-4, 9}, {0, 10}, {5, 8}, {9, 4.6}, {11, 0}};
  EXPECT_LT(distant_error(make_cell(spec, 20), {-1, -1, 0.4}, 0.1), 2e-5);
}

// Without the projection the nodes take samples, which is right to 1e-2.
TEST(ScreenedForces, agree_with_samples_as_far_as_these_are_right) {
  Cell cell = make_cell(ellipsoid({25, 15, 15}), 20);
  cell.screened = nullptr;
  double const error = distant_error(cell, {-3, -1, 1}, 0.5);
  EXPECT_LT(error, 1e-2);
  EXPECT_GT(error, 1e-3);
}

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
  ImageWall wall;
  std::shared_ptr<ScreenedForces const> screened;
};

Cell make_cell(ShapeSpec const& spec, int order, bool is_curved = false) {
  auto const flow = std::make_shared<DirichletFlow const>(Surface(make_shape(spec), order), Side::interior, 1e-8);
  ImageWall const wall(flow->surface(), Side::interior, is_curved);
  return {flow, wall, make_screened_forces(wall, 1e-6)};
}

ShapeSpec ellipsoid(Vec3d semi_axes) {
  return {.kind = ShapeSpec::Kind::ellipsoid, .semi_axes = semi_axes};
}

Vec3d velocity(Cell const& cell, Vec3d x, Vec3d y, Vec3d f) {
  Radiation radiation({}, cell.flow, {.viscosity = viscosity, .evaluator = "direct", .accuracy = 1e-12,
                                      .near_periphery = cell.wall, .screened_forces = cell.screened});
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
  ShapeSpec const spec{.kind = ShapeSpec::Kind::revolution, .profile = {{-9, 0}, {-8, 5}, {-4, 9}, {0, 10}, {5, 8}, {9, 4.6}, {11, 0}}};
  EXPECT_LT(distant_error(make_cell(spec, 20), {-1, -1, 0.4}, 0.1), 2e-5);
}

namespace {

// Flow at x of the force f e at y = b e in a sphere of radius a, centre 0: the exact images [Oseen 1927] are a Stokeslet, a
// Stokes dipole and a source dipole along e at a^2 b e / b^2, whose strengths no slip determines.
Vec3d exact_flow_in_sphere(double a, double b, Vec3d e, Vec3d x) {
  using Singularities = Eigen::Matrix<double, 3, 4>;  // columns: force, images
  auto const singularities = [&](Vec3d at) {
    Vec3d const r = at - (a * a / b) * e, d = at - b * e;
    double const s = 1.0 / norm(r), s3 = s * s * s, r_e = dot(r, e);
    Singularities columns;
    columns.col(0) = to_eigen(1.0 / norm(d) * e + dot(d, e) / std::pow(norm(d), 3) * d);
    columns.col(1) = to_eigen(s * e + s3 * r_e * r);
    columns.col(2) = to_eigen(s3 * r - 3.0 * s3 * s * s * r_e * r_e * r);
    columns.col(3) = to_eigen(-s3 * e + 3.0 * s3 * s * s * r_e * r);
    return columns;
  };
  Vec3d const across = normalized(cross(e, Vec3d{0.3, 1, 0.2}));
  Eigen::Matrix<double, 60, 4> wall;
  for (int i = 0; i < 20; ++i)
    wall.middleRows<3>(3 * i) = singularities(a * std::cos(0.02 + 0.15 * i) * e + a * std::sin(0.02 + 0.15 * i) * across);
  Eigen::Vector3d const strengths = -wall.rightCols<3>().colPivHouseholderQr().solve(wall.col(0));
  EXPECT_LT((wall.col(0) + wall.rightCols<3>() * strengths).norm(), 1e-9 * wall.col(0).norm());
  Singularities const at_x = singularities(x);
  return 1.0 / (8 * M_PI * viscosity) * to_vec3(at_x.col(0) + at_x.rightCols<3>() * strengths);
}

// Largest error close to a force that is close to a sphere of radius 10, relative to the force's flow without a cell.
double near_error(Cell const& cell, double distance) {
  Vec3d const e = normalized(Vec3d{0.3, -0.5, 0.8}), across = normalized(cross(e, Vec3d{1, 2, 0}));
  double worst = 0.0;
  for (double const depth : {0.05, 0.5, 2.0})
    for (double const angle : {0.02, 0.1, 0.4}) {
      Vec3d const y = (10.0 - distance) * e, x = (10.0 - depth) * (std::cos(angle) * e + std::sin(angle) * across);
      Vec3d const error = velocity(cell, x, y, e) - exact_flow_in_sphere(10.0, 10.0 - distance, e, x);
      worst = std::max(worst, norm(error) * 8 * M_PI * viscosity * norm(x - y));
    }
  return worst;
}

}  // namespace

TEST(ScreenedForces, act_nearby_as_they_should_the_better_where_images_follow_the_curvature) {
  ShapeSpec const spec{.radius = 10.0};
  Cell const plane = make_cell(spec, 16), curved = make_cell(spec, 16, true);
  for (auto const& [distance, most] : {std::pair{0.02, 1e-5}, {0.2, 7e-4}, {1.0, 8e-3}}) {  // nodes are 2 um apart
    double const error = near_error(curved, distance);
    EXPECT_LT(error, most) << distance;
    EXPECT_LT(error, 0.25 * near_error(plane, distance)) << distance;
  }
}

// Without the projection the nodes take samples, which is right to 1e-2.
TEST(ScreenedForces, agree_with_samples_as_far_as_these_are_right) {
  Cell cell = make_cell(ellipsoid({25, 15, 15}), 20);
  cell.screened = nullptr;
  double const error = distant_error(cell, {-3, -1, 1}, 0.5);
  EXPECT_LT(error, 1e-2);
  EXPECT_GT(error, 1e-3);
}

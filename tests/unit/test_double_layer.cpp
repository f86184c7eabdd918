#include "surface/double_layer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace asterflow;

namespace {

Surface surface_of(Vec3d semi_axes, SphereGrid const& grid, double width = 0.0) {
  ShapeSpec const spec{.kind = ShapeSpec::Kind::ellipsoid, .semi_axes = semi_axes};
  auto shape = make_shape(spec);
  return width > 0.0 ? Surface(shape, grid, Grading(pole_frame(normalized(Vec3d{1, 1, 0.3})), width)) : Surface(shape, grid);
}

// A smooth density.
Eigen::VectorXd density(Surface const& surface) {
  Eigen::VectorXd q(3 * surface.size());
  for (std::size_t i = 0; i < surface.size(); ++i) {
    Vec3d const y = surface.nodes()[i];
    q.segment<3>(3 * i) << std::sin(y.x) + y.y * y.z, std::cos(y.y - y.x), std::exp(0.5 * y.z);
  }
  return q;
}

Eigen::Vector3d constant_sum(NodeRows const& rows) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (Eigen::Index i = 0; i < rows.cols(); i += 3) sum += rows.middleCols<3>(i);
  return sum.diagonal();
}

}  // namespace

TEST(DoubleLayer, constant_density_gives_one_inside_half_on_and_zero_outside) {
  for (Vec3d const axes : {Vec3d{1.5, 1, 1}, Vec3d{1.5, 1.2, 1}}) {
    DoubleLayer const layer(surface_of(axes, 8), Side::exterior, 8.0);
    EXPECT_LT((constant_sum(layer.rows({0.2, 0.3, 0.1})) - Eigen::Vector3d::Ones()).norm(), 1e-12);
    EXPECT_LT(constant_sum(layer.rows({2, 0.3, 0.1})).norm(), 1e-12);
    PointArray const q(layer.surface().size(), Vec3d{0, 1, 0});
    PointArray v(q.size());
    layer.apply(q, v);  // (-1/2 + D) q vanishes, the completion is left
    auto const load = layer.load(q);
    for (std::size_t i = 0; i < v.size(); ++i)
      EXPECT_LT(norm(v[i] - layer.velocity_of_load(load, layer.surface().nodes()[i])), 1e-6);
  }
}

TEST(DoubleLayer, both_kinds_of_rows_agree_at_any_distance) {
  Surface const surface = surface_of({1.5, 1, 1}, {14, 20});
  DoubleLayer const by_modes(surface, Side::interior, 11.0);
  GeneralRows const by_nodes(surface, 11.0);
  Eigen::VectorXd const q = density(surface);
  ClosestPoint const on = surface.shape().closest_point({1, 0.7, 0.5});
  for (double const distance : {1e-8, 1e-4, 0.01, 0.3, 3.0})
    for (double const side : {-1.0, 1.0}) {
      Vec3d const x = on.position + side * distance * on.normal;
      EXPECT_LT((by_modes.rows(x) * q - by_nodes.at(x) * q).norm(), 1e-9) << distance;
    }
}

TEST(DoubleLayer, jumps_by_the_density_across_the_surface) {
  Surface const surface = surface_of({1.5, 1.2, 1}, 14, 0.5);
  GeneralRows const rows(surface, 11.0);
  Eigen::VectorXd const q = density(surface);
  std::size_t const node = surface.size() / 3;
  Vec3d const x = surface.nodes()[node], n = surface.normals()[node];
  Eigen::Vector3d const on = rows.on_surface(node) * q, at = q.segment<3>(3 * node);
  double const step = 1e-7;  // the limits are reached linearly
  EXPECT_LT((rows.at(x - step * n) * q - on - 0.5 * at).norm(), 1e-5);
  EXPECT_LT((rows.at(x + step * n) * q - on + 0.5 * at).norm(), 1e-5);
}

TEST(DoubleLayer, crowding_the_nodes_does_not_change_the_integral) {
  Vec3d const x{1.2, 0.9, 0.6};
  Surface const plain = surface_of({1.5, 1.2, 1}, 24), crowded = surface_of({1.5, 1.2, 1}, 24, 0.4);
  Eigen::Vector3d const a = GeneralRows(plain, 11.0).at(x) * density(plain), b = GeneralRows(crowded, 11.0).at(x) * density(crowded);
  EXPECT_LT((a - b).norm(), 1e-7);
}

// So far that the quadrature meets the target itself: this was not a number.
TEST(DoubleLayer, takes_nodes_that_are_crowded_anywhere) {
  ShapeSpec const spec{.kind = ShapeSpec::Kind::ellipsoid, .semi_axes = {25, 15, 15}};
  Vec3d const pole{0.6417529228371007, 0.695897632996899, 0.32230369284162924};
  Surface const crowded(make_shape(spec), 13, Grading(pole_frame(pole), 0.0337));
  EXPECT_TRUE(DoubleLayer(crowded, Side::interior, 9.0).equation().allFinite());
}

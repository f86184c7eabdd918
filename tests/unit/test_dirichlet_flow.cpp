#include "surface/dirichlet_flow.hpp"

#include "base/error.hpp"
#include "base/random.hpp"
#include "kernels/stokeslet.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace asterflow;

namespace {

constexpr double pi = std::numbers::pi;

std::shared_ptr<Shape const> ellipsoid(Vec3d semi_axes) {
  ShapeSpec const spec{.kind = ShapeSpec::Kind::ellipsoid, .semi_axes = semi_axes};
  return make_shape(spec);
}

struct PointForce {
  Vec3d position, force;
  Vec3d velocity(Vec3d x) const {
    Vec3d const r = x - position;
    double const d = norm(r);
    return 1.0 / (8.0 * pi) * (force / d + (dot(r, force) / (d * d * d)) * r);
  }
  PointArray velocity(ConstPoints x) const {
    PointArray u;
    for (Vec3d const y : x) u.push_back(velocity(y));
    return u;
  }
};

Vec3d scaled(Vec3d a, Vec3d b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

Vec3d direction(int i) {
  return normalized(Vec3d{uniform_random(3, i, 0, 0) - 0.5, uniform_random(3, i, 0, 1) - 0.5, uniform_random(3, i, 0, 2) - 0.5});
}

// Largest error over 60 targets at each scale, relative to the largest velocity at that scale.
double field_error(Vec3d semi_axes, Side side, SphereGrid const& grid, double accuracy, double source_scale,
                   Vec3d source_direction = {0.3, 0.8, 0.5}) {
  DirichletFlow const flow(Surface(ellipsoid(semi_axes), grid), side, accuracy);
  PointForce const source{source_scale * scaled(semi_axes, normalized(source_direction)), {0.4, -0.7, 0.9}};
  PointArray const w = source.velocity(flow.surface().nodes());
  double worst = 0.0;
  for (double const depth : {0.0, 1e-12, 1e-6, 1e-4, 1e-3, 1e-2, 0.1, 0.5, 0.9, 0.999, 1.0}) {
    if (side == Side::exterior && depth == 1.0) continue;  // infinitely far
    double const scale = side == Side::interior ? 1.0 - depth : 1.0 / (1.0 - depth);
    PointArray targets;
    for (int i = 0; i < 60; ++i) targets.push_back(scale * scaled(semi_axes, direction(i)));
    PointArray u(targets.size());
    flow.add_velocity(w, flow.plan(targets), u);
    double error = 0.0, largest = 0.0;
    for (std::size_t i = 0; i < u.size(); ++i) {
      error = std::max(error, norm(u[i] - source.velocity(targets[i])));
      largest = std::max(largest, norm(source.velocity(targets[i])));
    }
    worst = std::max(worst, error / largest);
  }
  return worst;
}

}  // namespace

TEST(DirichletFlow, meets_the_flow_of_an_outer_point_force_at_any_distance_inside) {
  EXPECT_LT(field_error({5, 5, 5}, Side::interior, 16, 1e-7, 3.0), 1e-6);
  EXPECT_LT(field_error({25, 15, 15}, Side::interior, 20, 1e-7, 3.0), 1e-6);
  EXPECT_LT(field_error({15, 25, 15}, Side::interior, 20, 1e-7, 3.0), 1e-6);
}

TEST(DirichletFlow, meets_the_flow_of_an_inner_point_force_at_any_distance_outside) {
  EXPECT_LT(field_error({5, 5, 5}, Side::exterior, 16, 1e-7, 0.3), 1e-6);
  EXPECT_LT(field_error({2, 2, 3}, Side::exterior, 26, 1e-7, 0.3), 1e-6);
}

TEST(DirichletFlow, converges_spectrally_with_the_order) {
  double const coarse = field_error({25, 15, 15}, Side::interior, 8, 1e-10, 2.5);
  double const fine = field_error({25, 15, 15}, Side::interior, 24, 1e-10, 2.5);
  EXPECT_LT(fine, coarse * 1e-5);  // the series falls by about 2.5 per order
}

TEST(DirichletFlow, more_rings_resolve_a_force_at_the_side_of_a_long_shape) {
  struct Case {
    Vec3d semi_axes;
    Side side;
    double source_scale;
    Vec3d at_the_side;
  };
  for (auto const& [axes, side, scale, source] : {Case{{25, 15, 15}, Side::interior, 1.5, {0.0, 0.8, 0.5}},
                                                  Case{{1, 1, 1.7}, Side::exterior, 0.6, {0.8, 0.5, 0.0}},
                                                  Case{{25, 15, 14}, Side::interior, 1.5, {0.0, 0.8, 0.5}}}) {
    SphereGrid const grid = grid_of_order(*ellipsoid(axes), 12), square = 15;
    EXPECT_EQ(grid.n_ring(), 20);
    EXPECT_LT(grid.size(), 1.1 * square.size());
    EXPECT_LT(field_error(axes, side, grid, 1e-7, scale, source), 0.5 * field_error(axes, side, square, 1e-7, scale, source));
  }
}

TEST(DirichletFlow, triaxial_ellipsoid_meets_the_flow_of_a_point_force_on_both_sides) {
  EXPECT_LT(field_error({12, 25, 15}, Side::interior, 16, 1e-5, 3.0), 3e-4);
  EXPECT_LT(field_error({2, 1.5, 1}, Side::exterior, 16, 1e-5, 0.2), 1e-3);  // 1.7 an order
}

TEST(DirichletFlow, low_order_serves_a_preconditioner) {
  EXPECT_LT(field_error({25, 15, 15}, Side::interior, 6, 1e-3, 3.0), 2e-2);
}

TEST(DirichletFlow, sphere_has_its_exact_resistance) {
  double const a = 5.0;
  DirichletFlow const flow(Surface(ellipsoid({a, a, a}), 8), Side::exterior, 1e-8);
  Matrix6 exact = Matrix6::Zero();
  exact.diagonal() << Eigen::Vector3d::Constant(6.0 * pi * a), Eigen::Vector3d::Constant(8.0 * pi * a * a * a);
  EXPECT_LT((flow.resistance() - exact).norm() / exact.norm(), 1e-10);
}

TEST(DirichletFlow, load_is_the_force_and_torque_of_the_sources_inside) {
  for (Vec3d const axes : {Vec3d{2, 2, 2}, Vec3d{1, 2, 1}, Vec3d{2, 2, 1}}) {
    DirichletFlow const flow(Surface(ellipsoid(axes), 20), Side::exterior, 1e-8);
    PointForce const source{{0.1, -0.2, 0.15}, {0.4, -0.7, 0.9}};
    Vector6 const load = flow.load(source.velocity(flow.surface().nodes()));
    Vec3d const torque = cross(source.position, source.force);
    Vector6 exact;
    exact << source.force.x, source.force.y, source.force.z, torque.x, torque.y, torque.z;
    EXPECT_LT((load - exact).norm(), 1e-6);
  }
}

TEST(DirichletFlow, surface_of_revolution_meets_the_flow_of_a_point_force) {
  ShapeSpec spec;  // an egg, R = 10 + 3 cos(theta) + cos(2 theta), centred at x = 7
  spec.kind = ShapeSpec::Kind::revolution;
  for (int i = 0; i < 30; ++i) {
    double const theta = pi * (29 - i) / 29, radius = 10.0 + 3.0 * std::cos(theta) + std::cos(2.0 * theta);
    spec.profile.push_back({4.0 + radius * std::cos(theta), i == 0 || i == 29 ? 0.0 : radius * std::sin(theta)});
  }
  for (Side const side : {Side::interior, Side::exterior}) {
    DirichletFlow const flow(Surface(make_shape(spec), 24), side, 1e-8);
    PointForce const source{side == Side::interior ? Vec3d{7, 30, 5} : Vec3d{8, 1, -1}, {0.4, -0.7, 0.9}};
    PointArray targets;
    for (int i = 0; i < 200; ++i) {
      double const depth = std::pow(10.0, -12.0 * uniform_random(5, i, 0, 0)), scale = side == Side::interior ? 1.0 - depth : 1.0 / (1.0 - depth);
      SurfacePatch const patch = flow.surface().patch(pi * uniform_random(5, i, 0, 1), 2.0 * pi * uniform_random(5, i, 0, 2));
      targets.push_back(flow.surface().shape().centre() + scale * (patch.position - flow.surface().shape().centre()));
    }
    PointArray u(targets.size());
    flow.add_velocity(source.velocity(flow.surface().nodes()), flow.plan(targets), u);
    for (std::size_t i = 0; i < u.size(); ++i)
      EXPECT_LT(norm(u[i] - source.velocity(targets[i])), 1e-6 * norm(source.velocity(targets[i])));
  }
}

TEST(DirichletFlow, refuses_targets_on_the_wrong_side) {
  DirichletFlow const flow(Surface(make_shape({}), 6), Side::interior, 1e-3);
  PointArray const targets{{0, 0, 0.5}, {0, 0, 1.1}};
  EXPECT_THROW(flow.plan(targets), NumericalError);
}

TEST(DirichletFlow, rough_velocity_is_the_same_to_three_digits) {
  for (Side const side : {Side::interior, Side::exterior}) {
    DirichletFlow const flow(Surface(ellipsoid({25, 15, 15}), 14), side, 1e-8);
    PointForce const source{Vec3d{8, 9, -5} * (side == Side::interior ? 3.0 : 0.4), {0.4, -0.7, 0.9}};
    PointArray const w = source.velocity(flow.surface().nodes());
    PointArray targets;
    for (int i = 0; i < 200; ++i) {
      double const scale = 0.1 + 0.9 * uniform_random(4, i, 0, 0);
      targets.push_back((side == Side::interior ? scale : 1.0 / scale) * scaled({25, 15, 15}, direction(i)));
    }
    auto const planned = flow.plan(targets);
    PointArray u(targets.size()), rough(targets.size());
    flow.add_velocity(w, planned, u);
    flow.add_rough_velocity(w, planned, rough);
    double const size = flat(ConstPoints(u)).norm(), error = (flat(ConstPoints(u)) - flat(ConstPoints(rough))).norm();
    EXPECT_LT(error, 1e-3 * size);
    EXPECT_GT(error, 0.0);
  }
}

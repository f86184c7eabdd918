#include "surface/resistance.hpp"

#include "base/error.hpp"
#include "linalg/quadrature.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace asterflow;

namespace {

constexpr double pi = std::numbers::pi;

PlacedSurface ellipsoid(Vec3d semi_axes, Vec3d position = {}) {
  ShapeSpec const spec{.kind = ShapeSpec::Kind::ellipsoid, .semi_axes = semi_axes};
  return {make_shape(spec), position};
}

PlacedSurface sphere(double radius, Vec3d position = {}) { return ellipsoid({radius, radius, radius}, position); }

// Resistance of an ellipsoid in open fluid, viscosity 1 [Oberbeck 1876; Jeffery 1922]: with
//   chi = int d lambda / D,  alpha_i = int d lambda / ((a_i^2 + lambda) D),  D^2 = prod (a_i^2 + lambda),
// force 16 pi / (chi + a_i^2 alpha_i), torque 16 pi (a_j^2 + a_k^2) / (3 (a_j^2 alpha_j + a_k^2 alpha_k)).
Eigen::VectorXd oberbeck(Vec3d a) {
  auto const& rule = gauss_legendre(200);
  double chi = 0.0;
  Vec3d alpha;
  for (int i = 0; i < 200; ++i) {
    double const s = 0.5 * (1.0 + rule.nodes[i]), root = s / (1.0 - s), lambda = root * root;
    double const weight = 0.5 * rule.weights[i] * 2.0 * root / ((1.0 - s) * (1.0 - s));
    double const d = std::sqrt((a.x * a.x + lambda) * (a.y * a.y + lambda) * (a.z * a.z + lambda));
    chi += weight / d;
    for (int k = 0; k < 3; ++k) alpha[k] += weight / d / (a[k] * a[k] + lambda);
  }
  Eigen::VectorXd r(6);
  for (int i = 0; i < 3; ++i) {
    int const j = (i + 1) % 3, k = (i + 2) % 3;
    r[i] = 16.0 * pi / (chi + a[i] * a[i] * alpha[i]);
    r[3 + i] = 16.0 * pi * (a[j] * a[j] + a[k] * a[k]) / (3.0 * (a[j] * a[j] * alpha[j] + a[k] * a[k] * alpha[k]));
  }
  return r;
}

// Equal spheres of radius 1 along their line, force / (6 pi U): moving together [Stimson & Jeffery 1926], apart [Maude 1961].
double two_spheres(double distance, bool together) {
  double const alpha = std::acosh(0.5 * distance);
  double sum = 0.0;
  for (int n = 1; n < 2000 && n * alpha < 40.0; ++n) {
    double const k = 2.0 * n + 1.0, squared = std::pow(k * std::sinh(alpha), 2);
    double const bracket =
        together ? 1.0 - (4.0 * std::pow(std::sinh(0.5 * k * alpha), 2) - squared) / (2.0 * std::sinh(k * alpha) + k * std::sinh(2.0 * alpha))
                 : (4.0 * std::pow(std::cosh(0.5 * k * alpha), 2) + squared) / (2.0 * std::sinh(k * alpha) - k * std::sinh(2.0 * alpha)) - 1.0;
    sum += n * (n + 1.0) / ((2.0 * n - 1.0) * (2.0 * n + 3.0)) * bracket;
  }
  return 4.0 / 3.0 * std::sinh(alpha) * sum;
}

// 6 x 6 rotation of a resistance matrix.
Eigen::MatrixXd turned(Eigen::MatrixXd const& r, Eigen::Matrix3d const& rotation) {
  Eigen::MatrixXd q = Eigen::MatrixXd::Zero(6, 6);
  q.topLeftCorner<3, 3>() = q.bottomRightCorner<3, 3>() = rotation;
  return q * r * q.transpose();
}

}  // namespace

TEST(Resistance, sphere_at_the_centre_of_a_sphere_is_exact_to_1e_8_with_fewer_than_1000_nodes) {
  double const k = 1.0 / 3.0, mu = 0.7;
  Resistance const r = solve_resistance({sphere(5.0)}, sphere(15.0), {.viscosity = mu, .accuracy = 1e-9, .order = 14});
  double const force = (1.0 - std::pow(k, 5)) / (1.0 - 9.0 / 4.0 * k + 5.0 / 2.0 * std::pow(k, 3) - 9.0 / 4.0 * std::pow(k, 5) + std::pow(k, 6));
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(r.resistance(i, i) / (6.0 * pi * mu * 5.0 * force), 1.0, 1e-8);
    EXPECT_NEAR(r.resistance(3 + i, 3 + i) / (8.0 * pi * mu * 125.0), 1.0 / (1.0 - k * k * k), 1e-8);
  }
  EXPECT_NEAR(force, 2.975410, 1e-6);
  EXPECT_LT((r.resistance * r.mobility - Eigen::MatrixXd::Identity(6, 6)).norm(), 1e-10);
}

TEST(Resistance, spheroids_and_triaxial_ellipsoids_agree_with_oberbeck) {
  for (Vec3d const axes : {Vec3d{2, 1, 1}, Vec3d{1, 2, 2}, Vec3d{1.4, 1.2, 1}}) {
    int const order = axes.y == axes.z ? 20 : 14;  // the triaxial one is rounder
    Resistance const r = solve_resistance({ellipsoid(axes)}, std::nullopt, {.accuracy = 1e-8, .order = order});
    Eigen::VectorXd const exact = oberbeck(axes);
    EXPECT_LT((r.resistance.diagonal() - exact).norm() / exact.norm(), 1e-7);
    EXPECT_LT((r.resistance - Eigen::MatrixXd(exact.asDiagonal())).norm() / exact.norm(), 1e-7);
  }
}

TEST(Resistance, needles_and_discs_alone_meet_the_accuracy_by_themselves) {
  for (Vec3d const axes : {Vec3d{0.1, 0.1, 1}, Vec3d{2, 0.3, 2}}) {
    Resistance const r = solve_resistance({ellipsoid(axes, {3, 1, -2})}, std::nullopt, {.viscosity = 0.4, .accuracy = 1e-4});
    Eigen::VectorXd const exact = 0.4 * oberbeck(axes);
    for (int i = 0; i < 6; ++i) EXPECT_NEAR(r.resistance(i, i) / exact[i], 1.0, 1e-4);
    EXPECT_LT(r.error, 1e-4);
  }
}

TEST(Resistance, two_spheres_agree_with_their_exact_series_down_to_a_hundredth_of_a_radius) {
  struct Case {
    double gap;
    int order;
    double bound;
  };
  for (auto const& [gap, order, bound] : {Case{1.0, 10, 1e-6}, Case{0.1, 12, 1e-6}, Case{0.01, 14, 3e-5}}) {
    Resistance const r = solve_resistance({sphere(1.0), sphere(1.0, {0, 0, 2.0 + gap})}, std::nullopt, {.accuracy = 1e-7, .order = order});
    double const together = (r.resistance(2, 2) + r.resistance(2, 8)) / (6.0 * pi), apart = (r.resistance(2, 2) - r.resistance(2, 8)) / (6.0 * pi);
    EXPECT_NEAR(together / two_spheres(2.0 + gap, true), 1.0, bound) << gap;
    EXPECT_NEAR(apart / two_spheres(2.0 + gap, false), 1.0, bound) << gap;
  }
}

// A sphere inside a sphere, off its centre, turning about the line of their centres: in bispherical coordinates, alpha of
// the inner sphere and beta of the wall [Jeffery 1915],
//   torque = 8 pi mu a^3 sum over n >= 0 of (sinh(alpha) / sinh(alpha + n (alpha - beta)))^3.
TEST(Resistance, eccentric_sphere_in_a_sphere_turns_with_the_exact_torque) {
  double const a = 5.0, wall = 15.0, gap = 0.5, distance = wall - a - gap;
  double const inner = std::acosh((wall * wall - a * a - distance * distance) / (2.0 * a * distance));
  double const outer = std::acosh((wall * wall - a * a + distance * distance) / (2.0 * wall * distance));
  double sum = 0.0;
  for (int n = 0; n < 200; ++n) sum += std::pow(std::sinh(inner) / std::sinh(inner + n * (inner - outer)), 3);
  Resistance const r = solve_resistance({sphere(a, {0, distance, 0})}, sphere(wall), {.viscosity = 0.6, .accuracy = 1e-6});
  EXPECT_NEAR(r.resistance(4, 4) / (8.0 * pi * 0.6 * a * a * a * sum), 1.0, 1e-6);
  EXPECT_LT(r.error, 1e-6);
}

// Gap about 0.5 um, off the cell's axes.
TEST(Resistance, sphere_anywhere_near_the_wall_of_an_ellipsoid_meets_the_accuracy) {
  PlacedSurface const cell = ellipsoid({25, 15, 15}), body = sphere(5.0, {7.47, 7.47, 0.0});
  Resistance const chosen = solve_resistance({body}, cell, {.viscosity = 0.6, .accuracy = 1e-3});
  Resistance const fine = solve_resistance({body}, cell, {.viscosity = 0.6, .accuracy = 1e-5, .order = 15});
  EXPECT_LT((chosen.resistance - fine.resistance).norm() / fine.resistance.norm(), 1e-3);
  EXPECT_LT(chosen.error, 1e-3);
  EXPECT_LT(fine.error, 1e-4);
}

TEST(Resistance, turning_and_moving_the_scene_turns_the_answer) {
  Eigen::Quaterniond const turn = Eigen::Quaterniond(0.8, 0.3, -0.4, 0.2).normalized();
  PlacedSurface body = ellipsoid({1.5, 1, 1}, {0.6, 0.4, -0.2}), wall = ellipsoid({6, 4, 4});
  Resistance const plain = solve_resistance({body}, wall, {.accuracy = 1e-6, .order = 10});
  body.orientation = wall.orientation = turn;
  wall.position = {3, -2, 5};
  body.position = wall.to_laboratory({0.6, 0.4, -0.2});
  Resistance const moved = solve_resistance({body}, wall, {.accuracy = 1e-6, .order = 10});
  Eigen::MatrixXd const expected = turned(plain.resistance, turn.toRotationMatrix());
  EXPECT_LT((moved.resistance - expected).norm() / expected.norm(), 1e-6);
}

// A sphere that is no sphere to the program: its axis does not go through the contact.
TEST(Resistance, cell_given_by_a_profile_beside_the_origin_is_the_same_cell) {
  ShapeSpec spec;
  spec.kind = ShapeSpec::Kind::revolution;
  for (int i = 0; i <= 24; ++i) spec.profile.push_back({3.0 - 4.0 * std::cos(pi * i / 24), 4.0 * std::sin(pi * i / 24)});
  spec.profile.front()[1] = spec.profile.back()[1] = 0.0;
  PlacedSurface const cell{make_shape(spec), {}};
  Resistance const plain = solve_resistance({sphere(1.0, {1.0, 0.5, 0.0})}, sphere(4.0), {.accuracy = 1e-5, .order = 8});
  Resistance const moved = solve_resistance({sphere(1.0, {4.0, 0.5, 0.0})}, cell, {.accuracy = 1e-5, .order = 8});
  EXPECT_LT((moved.resistance - plain.resistance).norm() / plain.resistance.norm(), 1e-4);
}

TEST(Resistance, overlapping_surfaces_and_unresolved_gaps_are_refused) {
  EXPECT_THROW(solve_resistance({sphere(1.0), sphere(1.0, {1.5, 0, 0})}, std::nullopt, {}), SceneError);
  EXPECT_THROW(solve_resistance({sphere(5.0, {11, 0, 0})}, sphere(15.0), {}), SceneError);
  EXPECT_THROW(solve_resistance({sphere(1.0), sphere(1.0, {2.0 + 1e-6, 0, 0})}, std::nullopt, {}), NumericalError);
}

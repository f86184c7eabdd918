#include "system/torque_instability.hpp"

#include "base/error.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

using namespace asterflow;

namespace {

struct Cell {
  Vec3d semi_axes{25.0, 15.0, 15.0};  // um
  double radius = 5.0;                // um
  double centrosome = 5.0;            // um, of two asters at +- this along y; 0: one aster at the centre
  double start = 0.0;                 // um
  double opening = 80.0;              // degrees
};

Scene scene_of(Cell const& cell) {
  auto const aster = [&](double y) {
    return fmt::format("[[aster]]\nbody = \"pnc\"\nposition = [0.0, {}, 0.0]\naxis = [0.0, {}, 0.0]\n"
                       "centrosome_radius = {}\nopening = {}\ncount = 40\narrangement = \"even\"\n",
                       y, y < 0 ? -1.0 : 1.0, cell.start, cell.opening);
  };
  std::string text = fmt::format("[periphery]\nshape = \"ellipsoid\"\nsemi_axes = [{}, {}, {}]\n[[body]]\nname = \"pnc\"\n"
                                 "shape = \"sphere\"\nradius = {}\n",
                                 cell.semi_axes.x, cell.semi_axes.y, cell.semi_axes.z, cell.radius);
  text += aster(cell.centrosome);
  if (cell.centrosome > 0.0) text += aster(-cell.centrosome);
  return parse_scene(text, "test.toml");
}

// The same mean over the two asters, by the midpoint rule and the quadratic equation of line and ellipsoid.
TurningRates by_midpoint_rule(Cell const& cell, double alpha) {
  constexpr int n_polar = 2000, n_turn = 64;
  Vec3d const a = cell.semi_axes;
  double const lowest = std::cos(cell.opening * M_PI / 180.0);
  TurningRates sum;
  for (double const side : {1.0, -1.0})
    for (int i = 0; i < n_polar; ++i)
      for (int j = 0; j < n_turn; ++j) {
        double const c = lowest + (1.0 - lowest) * (i + 0.5) / n_polar, s = std::sqrt(1.0 - c * c);
        double const turn = 2.0 * M_PI * (j + 0.5) / n_turn, across = s * std::cos(turn);
        Vec3d const p{side * c * std::cos(alpha) - across * std::sin(alpha),
                      side * c * std::sin(alpha) + across * std::cos(alpha), s * std::sin(turn)};
        Vec3d const x{side * cell.centrosome * std::cos(alpha), side * cell.centrosome * std::sin(alpha), 0.0};
        auto const scaled = [&](Vec3d v) { return Vec3d{v.x / a.x, v.y / a.y, v.z / a.z}; };
        Vec3d const e = scaled(x), d = scaled(p);
        double const b = dot(e, d), length = (-b + std::sqrt(b * b + dot(d, d) * (1.0 - dot(e, e)))) / dot(d, d);
        Vec3d const end = x + length * p, normal = normalized(scaled(scaled(end)));
        double const push = cell.radius / (2.0 * n_polar * n_turn * length * length);
        sum.free_sliding -= push * cross(end, normal).z;
        sum.no_sliding -= push * cross(end, p).z;
      }
  return sum;
}

}  // namespace

TEST(TorqueInstability, agrees_with_an_independent_quadrature) {
  for (Vec3d const semi_axes : {Vec3d{25.0, 15.0, 15.0}, Vec3d{25.0, 15.0, 11.0}})
    for (double const angle : {-70.0, 10.0, 45.0}) {
      Cell const cell{.semi_axes = semi_axes};
      auto const ours = torque_instability(scene_of(cell), {angle}).front().continuum;
      auto const theirs = by_midpoint_rule(cell, angle * M_PI / 180.0);
      // The midpoint rule is of second order: 1 / (24 * 2000^2), times the second derivative.
      EXPECT_NEAR(ours.free_sliding, theirs.free_sliding, 1e-6 * std::abs(theirs.free_sliding));
      EXPECT_NEAR(ours.no_sliding, theirs.no_sliding, 1e-6 * std::abs(theirs.no_sliding));
    }
}

TEST(TorqueInstability, vanishes_along_and_across_the_cell_stable_along_it_only) {
  auto const points = torque_instability(scene_of({}), {-90, -89, -1, 0, 1, 89, 90});
  for (int const i : {0, 3, 6}) {
    EXPECT_LT(std::abs(points[i].continuum.free_sliding), 1e-13);
    EXPECT_LT(std::abs(points[i].continuum.no_sliding), 1e-13);
  }
  for (auto const law : {&TurningRates::free_sliding, &TurningRates::no_sliding}) {
    EXPECT_GT(points[1].continuum.*law, 0.0);  // away from -90, towards 0
    EXPECT_GT(points[2].continuum.*law, 0.0);
    EXPECT_LT(points[4].continuum.*law, 0.0);
    EXPECT_LT(points[5].continuum.*law, 0.0);
  }
}

TEST(TorqueInstability, is_absent_in_a_sphere) {
  for (auto const& point : torque_instability(scene_of({.semi_axes = {15.0, 15.0, 15.0}}), {17.0, 60.0})) {
    EXPECT_LT(std::abs(point.continuum.free_sliding), 1e-13);
    EXPECT_LT(std::abs(point.continuum.no_sliding), 1e-13);
  }
}

// Radius R (1 + e P_2(cos angle from x)) to first order in e; one aster at the centre, whose fibers start at a:
//   Omega / Omega_0 = e a R / (R - a)^2 d/dalpha P_2(cos alpha) <P_2>,  <P_2> = c (1 + c) / 2 over an opening of cosine c.
// A push along a fiber through the centre turns nothing.
TEST(TorqueInstability, of_a_nearly_spherical_cell_has_its_closed_form) {
  constexpr double e = 1e-5, radius = 15.0, a = 5.0, alpha = 0.6, opening = 50.0;
  Cell const cell{{radius * (1 + e), radius * (1 - e / 2), radius * (1 - e / 2)}, a, 0.0, a, opening};
  auto const rates = torque_instability(scene_of(cell), {alpha * 180.0 / M_PI}).front().continuum;
  double const c = std::cos(opening * M_PI / 180.0);
  double const exact = e * a * radius / std::pow(radius - a, 2) * -1.5 * std::sin(2 * alpha) * c * (1 + c) / 2;
  EXPECT_NEAR(rates.free_sliding, exact, 10 * e * std::abs(exact));
  EXPECT_LT(std::abs(rates.no_sliding), 1e-15);
}

TEST(TorqueInstability, does_not_depend_on_the_axes_of_the_body) {
  Scene const scene = scene_of({.semi_axes = {25.0, 15.0, 11.0}});
  Scene turned = scene;  // the same asters, told in the axes of a body that is turned
  Eigen::Quaterniond const turn(Eigen::AngleAxisd(1.1, Eigen::Vector3d(1.0, 2.0, -1.0).normalized()));
  turned.bodies[0].orientation = turn;
  for (auto& aster : turned.asters)
    for (Vec3d* v : {&aster.position, &aster.axis}) *v = to_vec3(turn.conjugate() * to_eigen(*v));
  auto const rates = torque_instability(scene, {40.0}).front().continuum;
  auto const same = torque_instability(turned, {40.0}).front().continuum;
  EXPECT_NEAR(same.free_sliding, rates.free_sliding, 1e-6 * std::abs(rates.free_sliding));  // of the quadrature
  EXPECT_NEAR(same.no_sliding, rates.no_sliding, 1e-6 * std::abs(rates.no_sliding));
}

TEST(TorqueInstability, of_many_fibers_approaches_that_of_ever_more) {
  Scene scene = scene_of({});
  double error_before = 1.0;
  for (int const count : {20, 200, 2000}) {
    for (auto& aster : scene.asters) aster.count = count;
    auto const point = torque_instability(scene, {40.0}).front();
    double const error = std::abs(point.fibers.no_sliding / point.continuum.no_sliding - 1.0);
    EXPECT_LT(error, error_before / 3);
    error_before = error;
  }
  EXPECT_LT(error_before, 1e-3);
}

TEST(TorqueInstability, refuses_scenes_without_cell_body_or_fibers) {
  EXPECT_THROW(torque_instability(parse_scene("", "test.toml"), {0.0}), SceneError);
  Scene scene = scene_of({});
  scene.asters.front().axis = {0.0, 0.0, 1.0};  // no angle to turn by
  EXPECT_THROW(torque_instability(scene, {0.0}), SceneError);
  for (auto& aster : scene.asters) aster.count = 0;
  EXPECT_THROW(torque_instability(scene, {0.0}), SceneError);
}

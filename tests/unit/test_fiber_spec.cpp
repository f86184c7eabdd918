#include "fiber/fiber_spec.hpp"

#include "base/error.hpp"
#include "fiber/fitted_centreline.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace asterflow;

namespace {

FiberSpec fiber_from(std::string const& text) { return read_fiber(parse_table(text, "scene.toml")); }
AsterSpec aster_from(std::string const& text) { return read_aster(parse_table(text, "scene.toml")); }

}  // namespace

TEST(FiberSpec, direction_is_normalised) {
  FiberSpec const fiber = fiber_from("position = [1, 2, 3]\ndirection = [0, 0, 2]\nlength = 4\nminus_end = \"hinged\"");
  EXPECT_EQ(fiber.direction.z, 1.0);
  EXPECT_EQ(fiber.position.y, 2.0);
  EXPECT_EQ(fiber.material.minus_end, MinusEnd::hinged);
}

TEST(FiberSpec, refuses_what_makes_no_fiber) {
  EXPECT_THROW(fiber_from("direction = [0, 0, 0]"), SceneError);
  EXPECT_THROW(fiber_from("length = -1"), SceneError);
  EXPECT_THROW(fiber_from("length = 0.04"), SceneError);  // as thick as long
  EXPECT_THROW(fiber_from("nodes = 5"), SceneError);
  EXPECT_THROW(fiber_from("nodes = 65"), SceneError);
  EXPECT_THROW(fiber_from("points = [[0, 0, 0]]"), SceneError);
  EXPECT_THROW(fiber_from("points = [[0, 0, 0], [1, 0, 0], [1, 0, 0]]"), SceneError);
  EXPECT_THROW(fiber_from("points = [[0, 0, 0], [1, 0, 0]]\nlength = 1"), SceneError);
  EXPECT_THROW(fiber_from("body = \"pnc\""), SceneError);
  EXPECT_THROW(fiber_from("stiffness = 1"), SceneError);
  EXPECT_THROW(aster_from("minus_end = \"free\""), SceneError);
  EXPECT_THROW(aster_from("length = 0.2"), SceneError);
  EXPECT_THROW(aster_from("count = -1"), SceneError);
}

TEST(FiberSpec, aster_points_away_from_its_body) {
  AsterSpec const aster = aster_from("position = [0, 5, 0]\nopening = 60\ncentrosome_radius = 0.25");
  EXPECT_EQ(aster.axis.y, 1.0);
  for (auto const& fiber : aster_fibers(aster, 200, 3, 1, 0)) {
    EXPECT_EQ(fiber.site.body, 3);
    EXPECT_NEAR(norm(fiber.site.direction), 1.0, 1e-14);
    EXPECT_GT(fiber.site.direction.y, 0.5 - 1e-12);
    EXPECT_NEAR(norm(fiber.site.position - aster.position), 0.25, 1e-14);
  }
}

TEST(FiberSpec, more_random_fibers_do_not_move_the_first_ones) {
  AsterSpec const aster = aster_from("lengths = \"exponential\"\nlength = 8");
  auto const few = aster_fibers(aster, 10, -1, 7, 2), many = aster_fibers(aster, 1000, -1, 7, 2);
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(few[i].length, many[i].length);
    EXPECT_EQ(few[i].site.position.x, many[i].site.position.x);
  }
  double mean = 0.0;
  for (auto const& fiber : many) mean += fiber.length / many.size();
  EXPECT_NEAR(mean, 8.0, 4 * 7.5 / std::sqrt(1000.0));  // four standard deviations
}

TEST(FiberSpec, reach_limits_the_length) {
  AsterSpec const aster = aster_from("length = 8");
  for (auto const& fiber : aster_fibers(aster, 10, -1, 7, 2, [](auto const&) { return 3.0; }))
    EXPECT_EQ(fiber.length, 3.0);
  for (auto const& fiber : aster_fibers(aster, 10, -1, 7, 2, [](auto const&) { return 0.1; }))
    EXPECT_EQ(fiber.length, 0.5);
}

TEST(FiberSpec, steady_lengths_are_exponential_up_to_the_cortex) {
  AsterSpec const aster = aster_from("lengths = \"steady\"");
  double const a = 0.5, b = 12.0;
  auto const reach = [&](auto const&) { return b; };
  for (double k : {0.2, 0.0, -0.1}) {
    auto const fibers = aster_fibers(aster, 4000, -1, 7, 2, reach, k);
    double mean = 0.0;
    for (auto const& fiber : fibers) {
      ASSERT_GE(fiber.length, a);
      ASSERT_LE(fiber.length, b);
      mean += fiber.length / fibers.size();
    }
    // int l exp(-k l) / int exp(-k l)
    double const width = b - a, exact = k == 0 ? 0.5 * (a + b) : a + 1 / k - width / std::expm1(k * width);
    EXPECT_NEAR(mean, exact, 4 * width / std::sqrt(12.0 * 4000)) << k;  // four standard deviations of the uniform case
  }
}

TEST(FiberSpec, curve_through_points_of_a_circle_is_that_arc) {
  PointArray points;
  double const radius = 3.0, angle = 1.0;
  for (int i = 0; i <= 40; ++i)
    points.push_back({radius * std::sin(angle * i / 40), radius * std::cos(angle * i / 40), 0});
  Centreline const shape = centreline_through(points, 16);
  // A natural spline has no curvature at its ends: an error of the first and last pieces only.
  EXPECT_NEAR(shape.length, radius * angle, 1e-5);
  EXPECT_LT(norm(plus_end(shape) - points.back()), 1e-3);
}

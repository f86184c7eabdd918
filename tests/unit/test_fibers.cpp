#include "fiber_fixture.hpp"

#include <gtest/gtest.h>

using namespace asterflow;
using namespace asterflow::test;

namespace {

// Decay rate of a small bending mode over one relaxation time in n_step steps, 1/s, times its time scale 1/(c E k^4).
double relative_decay_rate(BendingMode const& mode, int n_node, int n_step) {
  double const viscosity = 2.5, length = 10.0, rigidity = 10.0;
  Fibers fibers(viscosity);
  MinusEndSite const site{.kind = mode.is_clamped ? MinusEnd::clamped : MinusEnd::free};
  fibers.add({.bending_rigidity = rigidity, .n_node = n_node}, site,
             bent_centreline(length, n_node, 1e-5, [&](double a) { return mode.slope(a); }));
  double const rate = slender_body_mobility(length, 0.0125, viscosity) * rigidity * std::pow(mode.k / length, 4);
  double const dt = 1.0 / (rate * n_step);
  // The first step of a fiber is by backward Euler: leave it out of the measurement.
  fibers.begin_step();
  step(fibers, dt);
  double const before = fibers.elastic_energy();
  for (int i = 0; i < n_step; ++i) {
    fibers.begin_step();
    step(fibers, dt);
  }
  return 0.5 * std::log(before / fibers.elastic_energy());
}

}  // namespace

TEST(Fibers, free_fiber_bends_back_at_the_rate_of_its_first_mode) {
  EXPECT_NEAR(relative_decay_rate(BendingMode::free_free(), 16, 100), 1.0, 1e-3);
}

TEST(Fibers, clamped_fiber_bends_back_at_the_rate_of_its_first_mode) {
  EXPECT_NEAR(relative_decay_rate(BendingMode::clamped_free(), 16, 100), 1.0, 1e-3);
}

TEST(Fibers, stiff_fiber_on_a_body_has_the_drag_of_a_straight_line) {
  double const viscosity = 0.7, length = 4.0;
  Fibers fibers(viscosity);
  Vec3d const direction = normalized(Vec3d{1, 2, -1});
  fibers.add({.bending_rigidity = 1e12, .n_node = 8}, {.kind = MinusEnd::clamped, .body = 0, .direction = direction},
             straight_centreline({}, direction, length, 8));
  BodyMotionMap const body{.displacement_per_velocity = 0.01, .turn_per_angular_velocity = 0.01 * Matrix3::Identity()};
  fibers.begin_step();
  fibers.prepare(0.01, {&body, 1});
  Vector6 velocity = Vector6::Zero(), load = Vector6::Zero();
  velocity.head<3>() << 1.0, -2.0, 0.5;
  PointArray const u(fibers.node_count());
  PointArray f(fibers.node_count());
  fibers.add_affine_response(f, {&load, 1});
  fibers.add_linear_response(u, {&velocity, 1}, f, {&load, 1});
  Vec3d const v{1.0, -2.0, 0.5}, along = dot(v, direction) * direction;
  Vec3d const drag = (length / slender_body_mobility(length, 0.0125, viscosity)) * (v - 0.5 * along);
  // rounding of the tangents times the bending rigidity
  EXPECT_LT(norm(to_vec3(load.head<3>()) + drag), 1e-7 * norm(drag));
  Vec3d const torque = cross(0.5 * length * direction, drag);
  EXPECT_LT(norm(to_vec3(load.tail<3>()) + torque), 1e-7 * norm(torque));
}

TEST(Fibers, straight_fiber_moves_exactly_under_a_uniform_force) {
  double const viscosity = 0.7, length = 4.0, dt = 0.3;
  Fibers fibers(viscosity);
  Vec3d const direction = normalized(Vec3d{1, 2, -1}), force{1.0, -2.0, 0.5}, start{3, 4, 5};
  fibers.add({.load = {.external = force}, .n_node = 8}, {}, straight_centreline(start, direction, length, 8));
  for (int i = 0; i < 3; ++i) {
    fibers.begin_step();
    step(fibers, dt);
  }
  double const c = slender_body_mobility(length, 0.0125, viscosity);
  Vec3d const velocity = c * (force + dot(force, direction) * direction);
  EXPECT_LT(norm(fibers.shape(0).minus_end - start - 3 * dt * velocity), 1e-13 * norm(velocity));
  EXPECT_LT(norm(fibers.shape(0).tangents.back() - direction), 1e-13);
}

TEST(Fibers, error_of_a_step_is_the_root_of_the_mean_square_over_fibers) {
  auto const error_beside = [](int n_still) {
    Fibers fibers(1.0);
    BendingMode const mode = BendingMode::free_free();
    fibers.add({.n_node = 12}, {}, bent_centreline(5.0, 12, 0.05, [&](double a) { return mode.slope(a); }));
    for (int i = 0; i < n_still; ++i) fibers.add({.n_node = 12}, {}, straight_centreline({0, 9, 0}, {1, 0, 0}, 5.0, 12));
    double error = 0.0;
    for (int i = 0; i < 4; ++i) {
      fibers.begin_step();
      error = step(fibers, 0.2);
    }
    return error;
  };
  double const alone = error_beside(0);
  EXPECT_GT(alone, 1e-9);
  EXPECT_NEAR(error_beside(3), alone / 2, 1e-6 * alone);
  EXPECT_NEAR(error_beside(399), alone / 10, 1e-6 * alone);  // not below a tenth of the worst
}

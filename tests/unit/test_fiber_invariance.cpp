// What must not change, and extremes to survive.
#include "fiber_fixture.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

using namespace asterflow;
using namespace asterflow::test;

namespace {

Matrix3 const turn = Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
Vec3d const shift{30, -20, 10};

Vec3d flow(Vec3d x) { return {0.6 * x.y, 0.2 * std::sin(x.x), 0.1 * x.z * x.z}; }

double wavy_slope(double a) { return std::sin(9 * a) + a; }

// Five steps of a bent fiber in that flow, the whole scene turned and shifted.
Centreline run(bool is_moved) {
  Fibers fibers(0.8);
  Centreline shape = bent_centreline(6.0, 16, 0.4, [](double a) { return std::sin(3 * a) * a * a; });
  shape.minus_end = {1, 1, 1};
  if (is_moved) {
    shape.minus_end = turn * shape.minus_end + shift;
    for (Vec3d& t : shape.tangents) t = turn * t;
  }
  fibers.add({}, {.kind = MinusEnd::hinged, .position = shape.minus_end}, shape);
  Matrix3 const back = turn.transpose();
  for (int i = 0; i < 5; ++i) {
    fibers.begin_step();
    step(fibers, 0.05, [&](Vec3d x) { return is_moved ? turn * flow(back * (x - shift)) : flow(x); });
  }
  return fibers.shape(0);
}

}  // namespace

TEST(FiberInvariance, turned_and_shifted_scene_gives_the_turned_and_shifted_answer) {
  Centreline const still = run(false), moved = run(true);
  for (std::size_t j = 0; j < still.tangents.size(); ++j)
    EXPECT_LT(norm(turn * still.tangents[j] - moved.tangents[j]), 1e-11);
}

TEST(FiberInvariance, straight_fiber_grows_and_shrinks_without_moving_anything) {
  Fibers fibers(1.0);
  Vec3d const direction = normalized(Vec3d{1, 2, 3});
  fibers.add({}, {}, straight_centreline({1, 2, 3}, direction, 3.0, 16));
  double length = 3.0;
  for (double change : {0.5, 0.4, -1.0, -1.2, 2.0}) {
    fibers.begin_step();
    fibers.plan(0).length = length += change;
    fibers.prepare(0.7, {});
    PointArray f(fibers.node_count());
    fibers.add_affine_response(f, {});
    for (Vec3d force : f) EXPECT_LT(norm(force), 1e-12);
    fibers.advance(PointArray(fibers.node_count()), {}, {});
    fibers.accept();
    EXPECT_EQ(fibers.shape(0).length, length);
    EXPECT_LT(norm(plus_end(fibers.shape(0)) - Vec3d{1, 2, 3} - length * direction), 1e-12);
  }
}

TEST(FiberInvariance, free_fiber_exerts_no_net_force) {
  Fibers fibers(1.7);
  fibers.add({}, {}, bent_centreline(8.0, 16, 0.5, [](double a) { return std::sin(3 * a); }));
  for (int i = 0; i < 10; ++i) {
    fibers.begin_step();
    fibers.prepare(0.1, {});
    PointArray u, f(fibers.node_count());
    for (Vec3d x : fibers.nodes()) u.push_back(flow(x));
    fibers.add_affine_response(f, {});
    fibers.add_linear_response(u, {}, f, {});
    Vec3d net;
    double largest = 0.0;
    for (std::size_t k = 0; k < f.size(); ++k) {
      net += fibers.weights()[k] * f[k];
      largest = std::max(largest, fibers.weights()[k] * norm(f[k]));
    }
    EXPECT_LT(norm(net), 1e-11 * largest);
    fibers.advance(u, {}, {});
    fibers.accept();
  }
}

TEST(FiberInvariance, energy_never_grows_without_forcing_when_steps_resolve_the_motion) {
  for (double dt : {1e-4, 1e-2})
    for (MinusEnd const end : {MinusEnd::free, MinusEnd::hinged, MinusEnd::clamped}) {
      Fibers fibers(1.0);
      Centreline const shape = bent_centreline(5.0, 16, 0.5, wavy_slope);
      fibers.add({}, {.kind = end, .direction = shape.tangents[0]}, shape);
      double energy = fibers.elastic_energy();
      for (int i = 0; i < 100; ++i) {
        fibers.begin_step();
        step(fibers, dt);
        EXPECT_LE(fibers.elastic_energy(), energy) << "dt " << dt << " step " << i;
        energy = fibers.elastic_energy();
      }
    }
}

// A multistep scheme lets a mode that it does not resolve change sign while it decays, so that its energy may rise
// after a step in which it was almost zero. What never grows is the energy of its two levels,
// |k_new|^2 + |2 k_new - k_now|^2 with the curvature k [Dahlquist 1978].
TEST(FiberInvariance, energy_of_both_levels_never_grows_however_long_the_step) {
  for (double dt : {1e-4, 1e-2, 1.0, 100.0})
    for (MinusEnd const end : {MinusEnd::free, MinusEnd::hinged, MinusEnd::clamped}) {
      Fibers fibers(1.0);
      Centreline const shape = bent_centreline(5.0, 16, 0.1, wavy_slope);
      fibers.add({}, {.kind = end, .direction = shape.tangents[0]}, shape);
      double const start = fibers.elastic_energy();
      double energy = 1e300;
      for (int i = 0; i < 30; ++i) {
        Centreline ahead = fibers.shape(0);
        fibers.begin_step();
        step(fibers, dt);
        Centreline const& now = fibers.shape(0);
        for (std::size_t j = 0; j < now.tangents.size(); ++j)
          ahead.tangents[j] = 2.0 * now.tangents[j] - ahead.tangents[j];
        double const levels = squared_curvature(now) + squared_curvature(ahead);
        // one in a thousand for tangents that are put back to unit length
        EXPECT_LE(levels, energy * (1 + 1e-3) + 1e-20) << "dt " << dt << " step " << i;
        EXPECT_LE(fibers.elastic_energy(), start);
        energy = levels;
      }
    }
}

TEST(FiberInvariance, tangents_keep_their_length_to_rounding) {
  Centreline const shape = run(false);
  for (Vec3d t : shape.tangents) EXPECT_NEAR(norm(t), 1.0, 1e-15);
}

TEST(FiberInvariance, restart_continues_exactly) {
  auto const make = [] {
    Fibers fibers(1.0);
    fibers.add({}, {}, bent_centreline(5.0, 16, 0.5, [](double a) { return std::sin(5 * a); }));
    fibers.add({.n_node = 8}, {.kind = MinusEnd::hinged}, bent_centreline(2.0, 8, 0.5, [](double a) { return a; }));
    return fibers;
  };
  auto const run_steps = [](Fibers& fibers, int n) {
    for (int i = 0; i < n; ++i) {
      fibers.begin_step();
      step(fibers, 0.1, flow);
    }
  };
  Fibers whole = make(), first = make(), second = make();
  run_steps(whole, 9);
  run_steps(first, 5);
  second.restore(first.state());
  run_steps(second, 4);
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t j = 0; j < whole.shape(i).tangents.size(); ++j)
      EXPECT_EQ(norm(whole.shape(i).tangents[j] - second.shape(i).tangents[j]), 0.0);
}

// Slenderness 1e-4 to 1e-1, length 0.05 to 50 um, rigidity over six decades, steps of 1e-4 to 10 s, viscosity 1e-3 to
// 1e3.
TEST(FiberInvariance, extremes_stay_finite_and_inside_the_flow) {
  for (double slenderness : {1e-4, 1e-1})
    for (double length : {0.05, 50.0})
      for (double rigidity : {1e-2, 1e4})
        for (double dt : {1e-4, 10.0})
          for (double viscosity : {1e-3, 1e3}) {
            Fibers fibers(viscosity);
            Centreline const shape = bent_centreline(length, 12, 0.1, [](double a) { return std::sin(3 * a); });
            fibers.add({.bending_rigidity = rigidity, .radius = slenderness * length, .n_node = 12}, {}, shape);
            double const shear_rate = 0.1;
            for (int i = 0; i < 20; ++i) {
              fibers.begin_step();
              step(fibers, dt, [&](Vec3d x) { return Vec3d{shear_rate * x.y, 0, 0}; });
            }
            Vec3d const end = plus_end(fibers.shape(0)), start = fibers.shape(0).minus_end;
            ASSERT_TRUE(std::isfinite(norm(end)));
            EXPECT_LE(norm(end - start), length * (1 + 1e-9));
            // Drifts no faster than the flow where it is, summed over the run.
            EXPECT_LT(norm(start), length * (2 + 20 * shear_rate * dt));
          }
}

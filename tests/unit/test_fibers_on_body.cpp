// Flexible fibers on a free rigid sphere, without hydrodynamic interactions: body and fibers in one implicit step.
#include "body/rigid_body.hpp"
#include "fiber_fixture.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>

using namespace asterflow;
using namespace asterflow::test;

namespace {

constexpr double viscosity = 1.3, radius = 1.0;

struct Swimmer {
  RigidBody body;
  Fibers fibers{viscosity};
  Vector6 imbalance = Vector6::Zero();  // of force and torque on the fluid in the last step
  double largest = 0.0;                 // force or torque in it
  std::vector<NodeLoad> node_loads{};   // on every fiber; empty: none

  explicit Swimmer(MinusEnd minus_end, double pull = 1.0)
      : body([] {
          BodySpec spec;
          spec.position = {0.5, -1, 2};
          spec.force = {5, 2, -3};
          spec.torque = {10, -5, 30};
          return spec;
        }()) {
    for (Vec3d d : {Vec3d{1, 0, 0}, normalized(Vec3d{-1, 2, 0}), normalized(Vec3d{0, -1, 1})}) {
      FiberProperties properties{.bending_rigidity = 4.0, .n_node = 12};
      properties.tip.force = pull * Vec3d{0.2, -0.1, 0.3};
      properties.tip.stiffness.diagonal() << 0.02 * pull, 0.0, 0.05 * pull;
      Vec3d const site = radius * d;
      fibers.add(properties, {.kind = minus_end, .body = 0, .position = site, .direction = d},
                 straight_centreline(body.pose().position + site, d, 4.0, 12));
    }
  }

  // Of the loads of a flow on the body with those that come with the fibers' forces.
  double disagreement_of_loads() const {
    PointArray u, f(fibers.node_count());
    for (Vec3d x : fibers.nodes()) u.push_back({std::sin(x.y), 0.3 * x.z * x.x, std::cos(x.x)});
    Vector6 const rest = Vector6::Zero();
    Vector6 load = rest, alone = rest;
    fibers.add_linear_response(u, {&rest, 1}, f, {&load, 1});
    fibers.add_loads(u, {&alone, 1});
    return (load - alone).norm() / load.norm();
  }

  void step(double dt) {
    BodyMotionMap const& map = body.predict(dt);
    fibers.begin_step();
    for (std::size_t i = 0; i < fibers.count(); ++i) fibers.plan(i).node_loads = node_loads;
    fibers.prepare(dt, {&map, 1});
    PointArray const still(fibers.node_count());
    PointArray f(fibers.node_count());
    Vector6 const external = body.external_load();
    Vector6 drag;  // of the bare sphere
    drag << Eigen::Vector3d::Constant(6 * std::numbers::pi * viscosity * radius),
        Eigen::Vector3d::Constant(8 * std::numbers::pi * viscosity * std::pow(radius, 3));
    Matrix6 resistance = drag.asDiagonal();
    Vector6 load = external;
    fibers.add_affine_response(f, {&load, 1});
    fibers.add_body_resistance({&resistance, 1});
    Vector6 const motion = resistance.lu().solve(load);
    load = external;
    f.assign(f.size(), Vec3d{});
    fibers.add_affine_response(f, {&load, 1});
    fibers.add_linear_response(still, {&motion, 1}, f, {&load, 1});
    body.advance(motion);
    RigidPose const pose = body.trial_pose();
    fibers.advance(still, {&motion, 1}, {&pose, 1});
    measure_balance(drag.cwiseProduct(motion), load, f, map.predicted.position);
    body.accept();
    fibers.accept();
  }

  // Force on the fluid: by the body its drag, which equals its load; by the fibers f. Together: external forces.
  void measure_balance(Vector6 const& by_body, Vector6 const& load, PointArray const& f, Vec3d centre) {
    EXPECT_LT((by_body - load).norm(), 1e-11 * load.norm());
    imbalance = by_body - body.external_load();
    for (std::size_t i = 0; i < f.size(); ++i) {
      Vec3d const force = fibers.weights()[i] * f[i], torque = cross(fibers.nodes()[i] - centre, force);
      imbalance += (Vector6() << to_eigen(force), to_eigen(torque)).finished();
    }
    largest = by_body.norm();
  }
};

Swimmer run(MinusEnd minus_end, int n_step) {
  Swimmer swimmer(minus_end);
  double const dt = 2.0 / n_step;
  double time = std::ldexp(dt, -12);
  swimmer.step(time);
  for (double piece = time; dt - time > 1e-12; time += piece, piece *= 2) swimmer.step(std::min(piece, dt - time));
  for (int i = 1; i < n_step; ++i) swimmer.step(dt);
  return swimmer;
}

double distance(Swimmer const& a, Swimmer const& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < 3; ++i)
    largest = std::max(largest, norm(plus_end(a.fibers.shape(i)) - plus_end(b.fibers.shape(i))));
  return largest;
}

}  // namespace

TEST(FibersOnBody, move_with_it_to_second_order_in_time) {
  for (MinusEnd const end : {MinusEnd::clamped, MinusEnd::hinged}) {
    Swimmer const a = run(end, 40), b = run(end, 80), c = run(end, 160);
    EXPECT_GT(std::log2(distance(a, b) / distance(b, c)), 1.8);
    EXPECT_LT(distance(b, c), 1e-2);
  }
}

TEST(FibersOnBody, minus_ends_stay_exactly_on_their_sites) {
  Swimmer const swimmer = run(MinusEnd::clamped, 20);
  RigidPose const pose = swimmer.body.pose();
  for (std::size_t i = 0; i < 3; ++i) {
    MinusEndSite const& site = swimmer.fibers.site(i);
    EXPECT_LT(norm(swimmer.fibers.shape(i).minus_end - pose.point(site.position)), 1e-13);
    EXPECT_LT(norm(swimmer.fibers.shape(i).tangents[0] - pose.rotation * site.direction), 1e-13);
  }
}

TEST(FibersOnBody, forces_and_torques_on_the_fluid_balance_what_is_applied) {
  for (MinusEnd const end : {MinusEnd::clamped, MinusEnd::hinged}) {
    Swimmer swimmer(end, 0.0);  // nothing but the external load on the body
    for (int i = 0; i < 10; ++i) {
      swimmer.step(0.05);
      EXPECT_LT(swimmer.imbalance.norm(), 1e-10 * swimmer.largest);
    }
  }
}

// Springs of another direction at every node, as from a curved wall; of every third one the body holds the other end.
std::vector<NodeLoad> springs_on_nodes() {
  std::vector<NodeLoad> loads;
  for (int i = 0; i < 12; ++i) {
    Eigen::Vector3d const n = Eigen::Vector3d(std::cos(i), std::sin(i), 0.3 * i).normalized();
    loads.push_back({.force = {0.1, -0.2, 0.05 * i}, .stiffness = (1.0 + i) * n * n.transpose(), .is_internal = i % 3 == 0});
  }
  return loads;
}

TEST(FibersOnBody, load_of_a_flow_is_the_same_when_springs_hold_the_nodes) {
  for (MinusEnd minus_end : {MinusEnd::clamped, MinusEnd::hinged}) {
    Swimmer swimmer(minus_end);
    swimmer.node_loads = springs_on_nodes();
    swimmer.step(0.05);
    EXPECT_LT(swimmer.disagreement_of_loads(), 1e-12);
  }
}

TEST(FibersOnBody, load_of_a_flow_is_the_same_with_and_without_the_force_density) {
  for (MinusEnd minus_end : {MinusEnd::clamped, MinusEnd::hinged}) {
    Swimmer swimmer(minus_end);
    for (int i = 0; i < 3; ++i) swimmer.step(0.05);
    EXPECT_LT(swimmer.disagreement_of_loads(), 1e-12);
  }
}

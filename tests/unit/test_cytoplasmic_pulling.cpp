#include "mechanism/cytoplasmic_pulling.hpp"

#include "fiber_fixture.hpp"
#include "kernels/stokeslet.hpp"
#include "system/simulation.hpp"

#include <gtest/gtest.h>

using namespace asterflow;

namespace {

constexpr double viscosity = 1.7;
Vec3d const along = normalized(Vec3d{1, -2, 0.5});

Fibers one_fiber(MinusEnd minus_end, double length, int n_node = 16) {
  Fibers fibers(viscosity);
  fibers.add({.n_node = n_node}, {.kind = minus_end, .position = {1, 2, 3}, .direction = along},
             straight_centreline({1, 2, 3}, along, length, n_node));
  return fibers;
}

void step(Fibers& fibers, CytoplasmicPulling const& pulling, double dt) {
  fibers.begin_step();
  pulling.plan(fibers);
  test::step(fibers, dt);
}

}  // namespace

TEST(CytoplasmicPulling, motor_and_cargo_agree_on_force_and_speed) {
  CytoplasmicPullingSpec const spec{.stall_force = 1.3, .free_speed = 1.5, .cargo_radius = 0.2};
  double const force = motor_force(spec, viscosity);
  double const speed = force / (6 * M_PI * viscosity * 0.2);
  EXPECT_NEAR(force, 1.3 * (1 - speed / 1.5), 1e-14);
  EXPECT_EQ(motor_force({.motor_force = 0.7}, viscosity), 0.7);
}

TEST(CytoplasmicPulling, of_the_paper_is_five_sixths_of_the_stall_force) {
  EXPECT_NEAR(motor_force({}, 0.57), 0.83 * 1.1, 0.005);  // at the viscosity that the paper's 0.83 implies
}

TEST(CytoplasmicPulling, pulls_a_held_straight_fiber_with_density_times_force_times_length) {
  CytoplasmicPulling const pulling({.motor_density = 0.2, .motor_force = 0.9}, viscosity);
  for (MinusEnd const end : {MinusEnd::clamped, MinusEnd::hinged}) {
    Fibers fibers = one_fiber(end, 7.0);
    step(fibers, pulling, 0.5);
    double const force = 0.2 * 0.9 * 7.0;
    EXPECT_LT(norm(fibers.ends(0).minus_end - force * along), 1e-12 * force);
    EXPECT_LT(norm(fibers.ends(0).minus_end_torque), 1e-12 * force);
    EXPECT_EQ(norm(fibers.ends(0).plus_end), 0.0);
    EXPECT_EQ(fibers.load(0).motor, 0.2 * 0.9);
    auto const& nodes = fiber_basis(16).gauss.nodes;
    for (int i = 0; i < 16; ++i) EXPECT_NEAR(fibers.tension(0)[i], force * (1 - nodes[i]), 1e-12 * force);
    EXPECT_LT(norm(plus_end(fibers.shape(0)) - Vec3d{1, 2, 3} - 7.0 * along), 1e-13);
  }
}

TEST(CytoplasmicPulling, moves_a_free_fiber_that_others_do_not_feel) {
  CytoplasmicPulling const pulling({.motor_density = 0.2, .motor_force = 0.9}, viscosity);
  Fibers fibers = one_fiber(MinusEnd::free, 7.0);
  fibers.begin_step();
  pulling.plan(fibers);
  fibers.prepare(0.5, {});
  PointArray f(fibers.node_count());
  fibers.add_affine_response(f, {});
  for (Vec3d const& density : f) EXPECT_LT(norm(density), 1e-14);
  fibers.advance(PointArray(f.size()), {}, {});
  fibers.accept();
  double const speed = 2 * slender_body_mobility(7.0, 0.0125, viscosity) * 0.2 * 0.9;  // U = 2 c f along the fiber
  EXPECT_LT(norm(fibers.shape(0).minus_end - Vec3d{1, 2, 3} - 0.5 * speed * along), 1e-13);
  EXPECT_LT(norm(fibers.ends(0).minus_end), 1e-13);
}

TEST(CytoplasmicPulling, with_trailing_cargo_a_straight_fiber_flows_as_two_stokeslets_at_its_ends) {
  CytoplasmicPulling const pulling({.motor_density = 0.2, .motor_force = 0.9, .cargo_offset = 0.3}, viscosity);
  Fibers fibers = one_fiber(MinusEnd::clamped, 7.0, 40);
  fibers.begin_step();
  fibers.prepare(0.5, {});
  PointArray f(fibers.node_count());
  pulling.add_dipoles(fibers, f);
  Vec3d const tension = 0.2 * 0.9 * 0.3 * along, minus = {1, 2, 3}, plus = minus + 7.0 * along;
  for (Vec3d const& x : {Vec3d{1, 2, 6}, {5, 0, 3}, {-4, 5, 1}}) {  // 2.8 um away and more: rho^-40 with rho = 2.1
    Vec3d sum;
    for (std::size_t i = 0; i < f.size(); ++i) sum += Stokeslet::velocity(x - fibers.nodes()[i], fibers.weights()[i] * f[i]);
    Vec3d const exact = Stokeslet::velocity(x - minus, tension) - Stokeslet::velocity(x - plus, tension);
    EXPECT_LT(norm(sum - exact), 1e-9 * norm(exact));
  }
}

TEST(CytoplasmicPulling, with_trailing_cargo_exerts_a_stress_without_force_and_torque) {
  Fibers fibers(viscosity);
  Centreline shape = straight_centreline({1, 2, 3}, along, 5.0, 16);
  for (std::size_t j = 0; j < shape.tangents.size(); ++j)
    shape.tangents[j] = normalized(shape.tangents[j] + (0.02 * j) * Vec3d{std::cos(0.3 * j), 1.0, 0.1 * j});
  fibers.add({.n_node = 16}, {.position = {1, 2, 3}}, shape);
  fibers.begin_step();
  fibers.prepare(1e-9, {});
  PointArray f(fibers.node_count());
  CytoplasmicPulling({.motor_density = 2.0, .motor_force = 0.5, .cargo_offset = 0.4}, viscosity).add_dipoles(fibers, f);
  Vec3d force, torque;
  double work = 0.0, trace = 0.0;
  for (std::size_t i = 0; i < f.size(); ++i) {
    Vec3d const x = fibers.nodes()[i], strength = fibers.weights()[i] * f[i];
    force += strength, torque += cross(x, strength), trace += dot(x, strength), work += norm(strength);
  }
  EXPECT_LT(norm(force), 1e-13 * work);
  EXPECT_LT(norm(torque), 1e-12 * work);
  EXPECT_NEAR(trace, -2.0 * 0.5 * 0.4 * 5.0, 1e-2);  // -n_dyn F_m b L: a puller; tangents between nodes are not of unit length
}

TEST(CytoplasmicPulling, forces_and_torques_on_the_body_balance_its_drag) {
  Simulation simulation(parse_scene(R"(
    [fluid]
    viscosity = 0.6
    [[body]]
    name = "pnc"
    shape = "sphere"
    radius = 2.0
    position = [1.0, 2.0, -1.0]
    [[aster]]
    body = "pnc"
    position = [0.0, 2.0, 0.0]
    axis = [1.0, 1.0, 0.3]
    opening = 50.0
    count = 7
    [cytoplasmic_pulling]
    [run]
    interactions = "local"
  )", "test.toml"));
  for (int i = 0; i < 4; ++i) simulation.step(10.0);
  RigidBody const& body = simulation.bodies()[0];
  RigidPose const& pose = body.motion_map().predicted;
  Vector6 balance = -simulation.resistance_alone(0, pose) * body.motion();
  double largest = 0.0;
  for (std::size_t i = 0; i < 7; ++i) {
    auto const& ends = simulation.fibers().ends(i);
    Vec3d const arm = pose.rotation * simulation.fibers().site(i).position;
    Vector6 load;
    load << to_eigen(ends.minus_end), to_eigen(ends.minus_end_torque + cross(arm, ends.minus_end));
    balance += load;
    largest = std::max(largest, load.norm());
  }
  EXPECT_GT(largest, 0.1);
  EXPECT_LT(balance.norm(), 1e-10 * largest);
}

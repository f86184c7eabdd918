#include "mechanism/steric_repulsion.hpp"

#include "base/error.hpp"
#include "fiber/fiber_basis.hpp"
#include "system/simulation.hpp"

#include <gtest/gtest.h>

using namespace asterflow;

namespace {

std::unique_ptr<Simulation> simulated(std::string const& scene, double end) {
  auto simulation = std::make_unique<Simulation>(parse_scene(scene, "test.toml"));
  while (simulation->time() < end) simulation->step(end);
  return simulation;
}

// Sum over the nodes of the repulsion by a sphere around the origin, pN, as the law gives it.
Vec3d repulsion_in_sphere(Fibers const& fibers, double radius, double force, double range) {
  Centreline const& shape = fibers.shape(0);
  auto const& rule = fiber_basis(fibers.properties(0).n_node).gauss;
  Vec3d sum;
  for (Eigen::Index i = 0; i < rule.nodes.size(); ++i) {
    double const s = rule.nodes[i] * shape.length;
    Vec3d position;
    sample(shape, {&s, 1}, {&position, 1}, {});
    double const distance = radius - norm(position);
    if (distance < range) sum -= (rule.weights[i] * shape.length * force * (1 - distance / range)) * normalized(position);
  }
  return sum;
}

// A sphere with a fiber clamped on it; the fiber is pressed against the wall and along the sphere.
std::string pressed_scene(std::string const& more) {
  return R"(
    [fluid]
    viscosity = 0.6
    [periphery]
    shape = "sphere"
    radius = 5.0
    [[body]]
    name = "pnc"
    shape = "sphere"
    radius = 2.0
    position = [0.0, 0.0, 0.0]
    force = [0.0, 0.0, 10.0]
    [[fiber]]
    body = "pnc"
    position = [0.0, 0.0, 2.0]
    direction = [0.6, 0.1, 1.0]
    length = 3.1
    nodes = 12
    minus_end = "clamped"
    force_density = [1.0, 0.0, -1.0]
    [steric_repulsion]
    range = 0.1
    [run]
    interactions = "local"
    accuracy = 1e-4
  )" + more;
}

}  // namespace

TEST(StericRepulsion, fiber_comes_to_rest_where_it_balances_the_load) {
  auto const simulation = simulated(R"(
    [fluid]
    viscosity = 0.6
    [periphery]
    shape = "sphere"
    radius = 4.0
    [[fiber]]
    position = [-1.0, 0.0, 3.7]
    direction = [1.0, 0.0, 0.0]
    length = 2.0
    force_density = [0.0, 0.0, 3.0]
    [steric_repulsion]
    range = 0.08
    fiber_force = 20.0
    [run]
    interactions = "local"
    accuracy = 1e-3
  )", 60.0);
  Vec3d const repulsion = repulsion_in_sphere(simulation->fibers(), 4.0, 20.0, 0.08);
  EXPECT_LT(norm(repulsion + simulation->fibers().ends(0).plus_end + Vec3d{0, 0, 6.0}), 0.02 * 6.0);
}

TEST(StericRepulsion, body_comes_to_rest_where_it_balances_the_load) {
  auto const simulation = simulated(R"(
    [fluid]
    viscosity = 0.6
    [periphery]
    shape = "ellipsoid"
    semi_axes = [6.0, 4.0, 4.0]
    [[body]]
    shape = "sphere"
    radius = 1.0
    position = [4.0, 0.0, 0.0]
    force = [30.0, 0.0, 0.0]
    [steric_repulsion]
    range = 0.1
    body_force = 100.0
    [run]
    interactions = "local"
  )", 20.0);
  EXPECT_NEAR(simulation->bodies()[0].pose().position.x, 5.0 - 0.07, 1e-5);  // 30 = 100 (1 - gap / 0.1)
}

TEST(StericRepulsion, forces_and_torques_on_the_body_balance_its_drag) {
  Simulation simulation(parse_scene(pressed_scene(""), "test.toml"));
  for (int i = 0; i < 200 && simulation.time() < 5.0; ++i) simulation.step(5.0);
  ASSERT_LT(norm(plus_end(simulation.fibers().shape(0))), 5.05);
  EXPECT_GT(norm(repulsion_in_sphere(simulation.fibers(), 5.0, 10.0, 0.1)), 0.02);
  RigidBody const& body = simulation.bodies()[0];
  RigidPose const& pose = body.motion_map().predicted;
  auto const& ends = simulation.fibers().ends(0);
  Vec3d const arm = pose.rotation * simulation.fibers().site(0).position;
  Vector6 load;
  load << to_eigen(ends.minus_end), to_eigen(ends.minus_end_torque + cross(arm, ends.minus_end));
  Vector6 const balance = load + body.external_load() - simulation.resistance_alone(0, pose) * body.motion();
  EXPECT_LT(balance.norm(), 1e-9 * load.norm());
}

TEST(StericRepulsion, body_holds_off_its_own_fiber) {
  auto const turned_in = [](bool repels) {
    std::string text = pressed_scene("end_time = 1.0\n[output]\n");
    text.replace(text.find("range = 0.1"), 11, std::string("range = 0.1\nfiber_force = 200.0\nfiber_body = ") + (repels ? "true" : "false"));
    text.replace(text.find("[1.0, 0.0, -1.0]"), 16, "[0.0, 0.0, -30.0]");
    text.replace(text.find("[0.6, 0.1, 1.0]"), 15, "[1.0, 0.0, 0.2]");
    text.replace(text.find("length = 3.1"), 12, "length = 1.6");
    text.replace(text.find("force = [0.0, 0.0, 10.0]"), 24, "motion = \"prescribed\"");
    Simulation simulation(parse_scene(text, "test.toml"));
    for (int i = 0; i < 1000 && simulation.time() < 5.0; ++i) simulation.step(5.0);
    Vec3d const centre = simulation.bodies()[0].pose().position;
    double least = 1e9;
    for (double s = 0.5; s <= 1.6; s += 0.1) {
      Vec3d x;
      sample(simulation.fibers().shape(0), {&s, 1}, {&x, 1}, {});
      least = std::min(least, norm(x - centre) - 2.0);
    }
    return least;
  };
  EXPECT_LT(turned_in(false), -0.1);
  EXPECT_GT(turned_in(true), -0.02);
}

TEST(StericRepulsion, plus_end_rests_on_a_body_that_does_not_hold_it) {
  auto const simulation = simulated(R"(
    [fluid]
    viscosity = 0.6
    [[body]]
    shape = "sphere"
    radius = 1.5
    position = [0.4, 0.3, 0.0]
    motion = "prescribed"
    [[fiber]]
    position = [6.0, 0.3, 0.0]
    direction = [-1.0, 0.0, 0.0]
    length = 3.0
    force_density = [-1.0, 0.0, 0.0]
    [steric_repulsion]
    range = 0.1
    fiber_body = true
    [run]
    interactions = "local"
    accuracy = 1e-4
  )", 4.0);
  EXPECT_LT(norm(simulation->fibers().ends(0).contact + simulation->fibers().ends(0).plus_end - Vec3d{3, 0, 0}), 1e-3);
  double const gap = plus_end(simulation->fibers().shape(0)).x - 1.9;
  EXPECT_GT(gap, 0.06);  // the plus end alone would carry it at 0.1 (1 - 3 / 10)
  EXPECT_LT(gap, 0.08);
}

TEST(StericRepulsion, body_rests_on_a_fiber_that_cannot_yield) {
  auto const simulation = simulated(R"(
    [fluid]
    viscosity = 0.6
    [[body]]
    shape = "sphere"
    radius = 1.0
    position = [0.0, 0.0, 1.2]
    force = [0.0, 0.0, -5.0]
    [[fiber]]
    position = [-1.0, 0.0, 0.0]
    direction = [1.0, 0.0, 0.0]
    length = 4.0
    minus_end = "clamped"
    bending_rigidity = 1e5
    [steric_repulsion]
    range = 0.1
    fiber_force = 1000.0
    fiber_body = true
    [run]
    interactions = "local"
    accuracy = 1e-3
  )", 12.0);
  EXPECT_NEAR(simulation->fibers().ends(0).contact.z, -5.0, 0.05);
}

TEST(StericRepulsion, body_feels_what_it_does_to_a_fiber_of_others) {
  Simulation simulation(parse_scene(R"(
    [fluid]
    viscosity = 0.6
    [[body]]
    shape = "ellipsoid"
    semi_axes = [2.0, 1.6, 1.5]
    position = [0.5, 0.2, 0.0]
    force = [1.0, 0.0, 0.0]
    [[fiber]]
    position = [-1.0, 0.3, 1.8]
    direction = [1.0, 0.0, 0.1]
    length = 3.0
    force_density = [0.0, 0.3, -1.0]
    [[fiber]]
    position = [5.7, 0.2, 0.5]
    direction = [-1.0, 0.0, 0.0]
    length = 3.0
    force_density = [-1.0, 0.0, 0.0]
    [steric_repulsion]
    range = 0.1
    fiber_body = true
    [run]
    interactions = "local"
    accuracy = 1e-3
  )", "test.toml"));
  Fibers const& fibers = simulation.fibers();
  double largest_side = 0.0, largest_tip = 0.0;
  while (simulation.time() < 2.0) {
    simulation.step(2.0);
    RigidBody const& body = simulation.bodies()[0];
    RigidPose const& pose = body.motion_map().predicted;
    Vector6 sum = simulation.resistance_alone(0, pose) * body.motion() - body.external_load();
    for (std::size_t i = 0; i < 2; ++i) {
      EndForces const& ends = fibers.ends(i);
      Centreline const& shape = fibers.predicted_shape(i);
      sum.head<3>() += to_eigen(ends.contact + ends.plus_end);
      sum.tail<3>() += to_eigen(ends.contact_torque + cross(shape.minus_end - pose.position, ends.contact) +
                                cross(plus_end(shape) - pose.position, ends.plus_end));
    }
    EXPECT_LT(sum.norm(), 1e-11);
    largest_side = std::max(largest_side, norm(fibers.ends(0).contact));
    largest_tip = std::max(largest_tip, norm(fibers.ends(1).plus_end));
  }
  EXPECT_GT(largest_side, 0.5);
  EXPECT_GT(largest_tip, 0.5);
}

TEST(StericRepulsion, of_a_plus_end_that_slides_on_a_body_converges_at_second_order) {
  auto const place = [&](double dt) {  // of the plus end
    auto const simulation = simulated(R"(
      [fluid]
      viscosity = 0.7
      [[body]]
      name = "a"
      shape = "ellipsoid"
      semi_axes = [1.5, 1.0, 1.2]
      position = [-2.6, 0.1, 0.0]
      force = [3.0, 0.5, 0.0]
      order = 8
      [[body]]
      shape = "sphere"
      radius = 1.1
      position = [2.9, 0.0, 0.2]
      force = [-4.0, 0.3, 0.2]
      order = 8
      [[fiber]]
      body = "a"
      position = [-1.05, 0.1, 0.0]
      direction = [1.0, 0.1, 0.05]
      length = 2.4
      minus_end = "hinged"
      bending_rigidity = 5.0
      [steric_repulsion]
      range = 0.1
      fiber_force = 20.0
      fiber_body = true
      [run]
      interactions = "local"
      adaptive = false
      time_step = )" + std::to_string(dt), 1.2);
    EXPECT_GT(norm(simulation->fibers().ends(0).plus_end), 0.5);
    return plus_end(simulation->fibers().shape(0));
  };
  Vec3d const rough = place(0.01), middle = place(0.005), fine = place(0.0025);
  EXPECT_LT(norm(middle - fine), norm(rough - middle) / 3.5);  // a quarter; walls that were found once a step: 0.6
  EXPECT_LT(norm(middle - fine), 1e-5);                         // um
}

// Two spheres pressed together with 30 pN along a direction of no symmetry, and what else the scene has.
std::string pressed_spheres(std::string const& level, std::string const& second) {
  return R"(
    [fluid]
    viscosity = 0.6
    [[body]]
    shape = "sphere"
    radius = 1.5
    position = [-1.2, -0.6, 0.4]
    force = [20.0, 20.0, -10.0]
    order = 8
    [[body]]
    shape = "sphere"
    radius = 1.0
    position = [1.2, 1.8, -0.8]
    order = 8
    )" + second + R"(
    [steric_repulsion]
    range = 0.1
    [run]
    accuracy = 1e-3
    interactions = ")" + level + "\"\n";
}

TEST(StericRepulsion, bodies_come_to_rest_where_they_balance_the_load) {
  for (char const* level : {"local", "open"})
    for (char const* second : {"force = [-20.0, -20.0, 10.0]", "motion = \"prescribed\""}) {
      auto const simulation = simulated(pressed_spheres(level, second), 3.0);  // later they slide off each other
      auto const& bodies = simulation->bodies();
      double const gap = norm(bodies[0].pose().position - bodies[1].pose().position) - 2.5;
      EXPECT_NEAR(gap, 0.07, 1e-4) << level << " " << second;  // 30 = 100 (1 - gap / 0.1)
    }
}

TEST(StericRepulsion, between_bodies_is_equal_and_opposite) {
  Simulation simulation(parse_scene(R"(
    [fluid]
    viscosity = 0.6
    [[body]]
    shape = "ellipsoid"
    semi_axes = [2.0, 1.6, 1.5]
    position = [-1.9, 0.2, 0.0]
    force = [9.0, 0.0, 2.0]
    order = 8
    [[body]]
    shape = "ellipsoid"
    semi_axes = [1.0, 1.6, 1.2]
    rotation_axis = [0.3, 0.2, 1.0]
    rotation_angle = 30.0
    position = [1.4, 0.9, 0.3]
    torque = [3.0, 0.0, 2.0]
    order = 8
    [steric_repulsion]
    [run]
    interactions = "local"
    accuracy = 1e-3
  )", "test.toml"));
  double largest = 0.0;
  while (simulation.time() < 6.0) {
    simulation.step(6.0);
    Vec3d force{}, torque{};  // on both, about the origin
    for (std::size_t b : {0, 1}) {
      RigidBody const& body = simulation.bodies()[b];
      RigidPose const& pose = body.motion_map().predicted;
      Vector6 const load = simulation.resistance_alone(b, pose) * body.motion() - body.external_load();
      force += to_vec3(load.head<3>());
      torque += to_vec3(load.tail<3>()) + cross(pose.position, to_vec3(load.head<3>()));
      largest = std::max(largest, load.norm());
    }
    EXPECT_LT(norm(force) + norm(torque), 1e-11);
  }
  EXPECT_GT(largest, 3.0);
}

TEST(StericRepulsion, of_bodies_converges_at_second_order) {
  auto const place = [&](double dt) {
    std::string text = pressed_spheres("local", "force = [-20.0, 0.0, 10.0]");
    text.replace(text.find("range = 0.1"), 11, "range = 0.4");  // they touch from the beginning, and slide
    auto const simulation = simulated(text + "adaptive = false\ntime_step = " + std::to_string(dt), 1.2);
    return simulation->bodies()[1].pose().position;
  };
  Vec3d const rough = place(0.02), middle = place(0.01), fine = place(0.005);
  EXPECT_LT(norm(middle - fine), norm(rough - middle) / 3.5);
  EXPECT_GT(norm(rough - middle), 1e-7);  // um
}

TEST(StericRepulsion, of_wrong_sign_is_refused) {
  std::string text = pressed_scene("");
  text.replace(text.find("range = 0.1"), 11, "range = -0.1");
  try {
    parse_scene(text, "test.toml");
    FAIL();
  } catch (SceneError const& error) {
    EXPECT_NE(std::string(error.what()).find("[steric_repulsion]: range = -0.1"), std::string::npos) << error.what();
  }
}

// Whole scenes against exact statements: motion of a spheroid in shear, balance of forces, decay of energy, lengths,
// the cost of what is absent, and extreme numbers.

#include "system/no_slip.hpp"
#include "system/simulation.hpp"

#include "io/frame.hpp"
#include "label_check.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

using namespace asterflow;

namespace {

Scene scene_of(std::string const& text) { return parse_scene(text, "test.toml"); }

// Two bent fibers beside each other, and a spheroid that holds a third one; nothing drives them.
std::string const relaxing = R"(
  [fluid]
  viscosity = 0.6
  [[body]]
  name = "seed"
  shape = "ellipsoid"
  semi_axes = [1.5, 1.0, 1.0]
  position = [0.0, -2.5, 0.0]
  order = 8
  [[fiber]]
  body = "seed"
  points = [[1.6, 0.0, 0.0], [3.5, 0.3, 0.2], [5.0, 1.0, 0.0]]
  minus_end = "clamped"
  nodes = 10
  [[fiber]]
  points = [[-2.0, 0.0, 0.0], [0.0, 1.0, 0.3], [2.0, 0.0, 0.0]]
  nodes = 10
  [[fiber]]
  points = [[-2.0, 0.6, 0.5], [0.0, 0.0, 0.5], [2.0, 0.8, 0.5]]
  nodes = 10
  [run]
  interactions = "open"
  accuracy = 1e-3
  gmres_tolerance = 1e-7
  evaluator_accuracy = 1e-9
  adaptive = false
  time_step = )";

double arc_length(Centreline const& shape) {
  constexpr int n = 400;
  std::vector<double> s;
  for (int i = 0; i < n; ++i) s.push_back(shape.length * (i + 0.5) / n);
  PointArray tangents(n);
  sample(shape, s, {}, tangents);
  double length = 0.0;
  for (Vec3d const t : tangents) length += shape.length / n * norm(t);
  return length;
}

int launches_of(std::map<std::string, int> const& launches, std::string const& part) {
  int count = 0;
  for (auto const& [label, n] : launches)
    if (label.find(part) != std::string::npos) count += n;
  return count;
}

std::map<std::string, int> launches_of_a_run(std::string const& scene) {
  return launches_during([&] {
    Simulation simulation(scene_of(scene));
    simulation.step(0.01);
  });
}

std::string const sphere = "[[body]]\nshape = \"sphere\"\nradius = 1.0\nforce = [1.0, 0.0, 0.0]\norder = 6\n";
std::string const fiber = "[[fiber]]\nposition = [0.0, 2.0, 0.0]\nlength = 3.0\nnodes = 8\nforce_density = [0.0, 0.1, 0.0]\n";
std::string const cell = "[periphery]\nshape = \"sphere\"\nradius = 8.0\norder = 6\n";
std::string const level = "[run]\naccuracy = 1e-3\ninteractions = ";

}  // namespace

// [Jeffery 1922]: a spheroid of aspect ratio r turns in shear G with tan(angle) = r tan(G t / (r + 1/r)), whoever else is there.
TEST(Physics, spheroid_in_shear_turns_with_the_period_of_Jeffery) {
  double const aspect = 2.0, shear = 0.5, period = 2.0 * M_PI / shear * (aspect + 1.0 / aspect);
  for (std::string const interactions : {"open", "local"}) {
    Simulation simulation(scene_of(R"(
      [background]
      shear_rate = 0.5
      [[body]]
      shape = "ellipsoid"
      semi_axes = [1.0, 2.0, 1.0]
      order = 12
      [run]
      accuracy = 1e-3
      step_tolerance = 1e-4
      interactions = ")" + interactions + "\"\n"));
    auto const angle_at = [&](double time) {  // of the long axis from y, towards x
      while (simulation.time() < time) simulation.step(time);
      Vec3d const axis = simulation.bodies()[0].pose().rotation * Vec3d{0, 1, 0};
      return std::atan2(axis.x, axis.y);
    };
    EXPECT_NEAR(angle_at(period / 8.0), std::atan(aspect), 2e-3) << interactions;
    EXPECT_NEAR(angle_at(period / 4.0), 0.5 * M_PI, 2e-3) << interactions;
  }
}

TEST(Physics, energy_never_grows_without_forcing_however_long_the_step) {
  for (double const dt : {1e-3, 1e-1, 10.0}) {
    Simulation simulation(scene_of(relaxing + fmt::format("{}", dt)));
    double const start = simulation.fibers().elastic_energy();
    for (int i = 0; i < 5; ++i) {
      simulation.step(1e9);
      // Long steps ring below the start (test_fiber_invariance.cpp); short ones only fall.
      EXPECT_LT(simulation.fibers().elastic_energy(), start * (1.0 + 1e-12)) << "dt " << dt << " step " << i;
    }
    EXPECT_LT(simulation.fibers().elastic_energy(), 0.9999 * start);
  }
}

TEST(Physics, closed_scene_exerts_no_net_force_and_torque_on_the_fluid) {
  Simulation simulation(scene_of(relaxing + "1e-4"));
  simulation.step(1.0);
  Frame const frame{simulation.time(), simulation.frame()};
  StoredFlow const flow(simulation.scene(), simulation.flows(), frame);
  auto const positions = points_of(frame, "fiber/position"), density = points_of(frame, "fiber/force_density");
  auto const weights = numbers_of(frame, "fiber/weight");
  Vec3d force, torque;
  double scale = 0.0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    Vec3d const f = weights[i] * density[i];
    force += f;
    torque += cross(positions[i], f);
    scale += norm(f);
  }
  PointArray incident(positions.size());
  incident.insert(incident.end(), flow.surface_incident().begin(), flow.surface_incident().end());
  RigidPose const pose = simulation.bodies()[0].pose();
  Vector6 const load =
      simulation.resistance_alone(0, pose) * flow.motions()[0] - flow.radiation().load_of_incident(0, incident);
  force += to_vec3(load.head<3>());
  torque += to_vec3(load.tail<3>()) + cross(pose.position, to_vec3(load.head<3>()));
  EXPECT_GT(scale, 0.1);
  EXPECT_LT(norm(force), 1e-4 * scale);
  EXPECT_LT(norm(torque), 1e-4 * scale * 5.0);  // arms of up to 5 um
}

TEST(Physics, fibers_keep_their_length_over_a_run) {
  Simulation simulation(scene_of(R"(
    [periphery]
    shape = "ellipsoid"
    semi_axes = [25.0, 15.0, 15.0]
    order = 10
    [[body]]
    name = "pnc"
    shape = "sphere"
    radius = 5.0
    position = [8.0, 0.0, 0.0]
    force = [-100.0, 0.0, 0.0]
    order = 8
    [[aster]]
    body = "pnc"
    position = [0.0, 5.0, 0.0]
    count = 8
    length = 6.0
    [run]
    accuracy = 1e-3
    end_time = 1e9
  )"));
  for (int i = 0; i < 12; ++i) simulation.step(1e9);
  EXPECT_GT(norm(simulation.bodies()[0].pose().position - Vec3d{8, 0, 0}), 1e-3);
  for (std::size_t i = 0; i < simulation.fibers().count(); ++i) {
    Centreline const& shape = simulation.fibers().shape(i);
    EXPECT_NEAR(arc_length(shape) / shape.length, 1.0, 1e-6) << i;
  }
}

TEST(Physics, what_is_absent_is_neither_computed_nor_allocated) {
  auto const local = launches_of_a_run(sphere + fiber + level + "\"local\"");
  EXPECT_EQ(launches_of(local, "Radiation"), 0);
  EXPECT_EQ(launches_of(local, "Sum"), 0);  // pair sums
  EXPECT_EQ(launches_of(local, "DirichletFlow"), 0);
  auto const bodies = launches_of_a_run(sphere + cell + level + "\"confined\"");
  EXPECT_GT(launches_of(bodies, "DirichletFlow"), 0);
  EXPECT_EQ(launches_of(bodies, "Sum"), 0);
  auto const open = launches_of_a_run(sphere + fiber + cell + level + "\"open\"");
  auto const confined = launches_of_a_run(sphere + fiber + cell + level + "\"confined\"");
  EXPECT_GT(launches_of(open, "Sum"), 0);
  EXPECT_LT(launches_of(open, "AxisymmetricDirichlet::shells"), launches_of(confined, "AxisymmetricDirichlet::shells"));
  auto const fibers = launches_of_a_run(fiber + level + "\"open\"");
  EXPECT_EQ(launches_of(fibers, "Dirichlet"), 0);
}

TEST(Physics, unknowns_are_those_of_the_objects_that_are_there) {
  auto const unknowns = [](std::string const& scene) {
    Simulation simulation(scene_of(scene));
    simulation.step(0.01);
    for (auto const& array : simulation.restart())
      if (array.name == "flow/incident") return array.shape[0];
    return std::size_t{0};
  };
  // order 6: 7 x 14 nodes
  EXPECT_EQ(unknowns(fiber + level + "\"open\""), 8u);
  EXPECT_EQ(unknowns(sphere + level + "\"open\""), 98u);
  EXPECT_EQ(unknowns(sphere + cell + level + "\"open\""), 98u);
  EXPECT_EQ(unknowns(sphere + fiber + cell + level + "\"confined\""), 98u + 98u + 8u);
  EXPECT_EQ(unknowns(""), 0u);
}

// Each survives with sense, or is refused in one line.
TEST(Physics, extremes_survive_or_are_refused_in_one_line) {
  std::string const fibers = R"(
    [[fiber]]
    position = [0.0, 3.0, 0.0]
    length = 0.05
    radius = 0.005
    bending_rigidity = 0.01
    [[fiber]]
    position = [-25.0, 2.0, 0.0]
    length = 50.0
    radius = 0.005
    bending_rigidity = 1e4
    force_density = [0.0, 0.01, 0.0]
    [[fiber]]
    position = [0.0, 2.0, -1.0]
    direction = [0.0, 0.0, 1.0]
    length = 2.0
  )";  // the last one crosses the second
  std::vector<std::string> scenes;
  for (char const* viscosity : {"1e-3", "1e3"})
    for (char const* dt : {"1e-4", "10.0"})
      scenes.push_back(fmt::format("[fluid]\nviscosity = {}\n{}{}[run]\ninteractions = \"open\"\naccuracy = 1e-2\n"
                                   "adaptive = false\ntime_step = {}\n", viscosity, sphere, fibers, dt));
  for (double const gap : {1e-3, 1e-6, -1e-3})  // of a sphere of radius 1 from the wall
    scenes.push_back(fmt::format("{}position = [{}, 0.0, 0.0]\n{}{}\"confined\"\n", sphere, 7.0 - gap, cell, level));
  scenes.push_back(cell + "[[fiber]]\nposition = [2.0, 0.0, 0.0]\nlength = 6.0\n" + level + "\"confined\"\n");  // touches
  scenes.push_back("[[aster]]\ncount = 0\n" + level + "\"open\"\n");
  scenes.push_back(cell);
  for (auto const& text : scenes) try {
      Simulation simulation(scene_of(text));
      simulation.step(1e9);
      for (auto const& body : simulation.bodies()) EXPECT_LT(norm(body.pose().position), 1e3) << text;
      for (std::size_t i = 0; i < simulation.fibers().count(); ++i)
        EXPECT_LT(norm(plus_end(simulation.fibers().shape(i))), 1e3) << text;
    } catch (std::runtime_error const& refusal) {
      EXPECT_EQ(std::string(refusal.what()).find('\n'), std::string::npos) << text;
      EXPECT_NE(std::string(refusal.what()), "") << text;
    }
}

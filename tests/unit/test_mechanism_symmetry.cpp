// No mechanism prefers a direction: a scene that is turned or mirrored goes the turned or mirrored way.

#include "system/simulation.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <gtest/gtest.h>

using namespace asterflow;

namespace {

std::string words(Vec3d x) { return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", x.x, x.y, x.z); }

// A ball in a spherical cell with fibers whose plus ends meet the cortex in the first 0.2 s. All places are taken
// through `image`; the ball turns by `turn`.
std::string scene_text(std::string const& mechanism, Matrix3 const& image, Eigen::Quaterniond const& turn) {
  std::string text = fmt::format(R"(
    [fluid]
    viscosity = 0.8
    [periphery]
    shape = "sphere"
    radius = 7.0
    [[body]]
    name = "ball"
    shape = "sphere"
    radius = 2.0
    position = {}
    orientation = [{:.17g}, {:.17g}, {:.17g}, {:.17g}]
    [dynamic_instability]
    shrinkage_speed = 2.0
    rescue_rate = 0.5
    catastrophe_rate = 0.5
    [run]
    interactions = "open"
    accuracy = 1e-2
    gmres_tolerance = 1e-10
    adaptive = false
    time_step = 0.025
  )", words(image * Vec3d{0.8, -0.3, 0.2}), turn.w(), turn.x(), turn.y(), turn.z());
  Vec3d const directions[] = {{1, 0.2, 0.1}, {-0.3, 1, 0.4}, {0.2, -0.9, 0.5}, {0.1, 0.3, -1}, {-0.8, -0.5, -0.2}};
  for (Vec3d const& away : directions) {
    Vec3d const d = normalized(away), start = Vec3d{0.8, -0.3, 0.2} + 2.2 * d;
    double const b = dot(start, d), reach = -b + std::sqrt(b * b - dot(start, start) + 6.88 * 6.88);
    text += fmt::format("[[fiber]]\nbody = \"ball\"\nminus_end = \"clamped\"\ngrowing = true\nnodes = 8\nposition = {}\n"
                        "direction = {}\nlength = {:.17g}\n", words(image * start), words(image * d), reach - 0.1);
  }
  std::string sites;
  for (Vec3d const& away : directions) sites += (sites.empty() ? "" : ", ") + words(image * (7.0 * normalized(away)));
  std::string tables = mechanism;
  if (auto const at = tables.find("SITES"); at != std::string::npos) tables.replace(at, 5, "[" + sites + "]");
  if (auto const at = tables.find("AXIS"); at != std::string::npos) tables.replace(at, 4, words(image * Vec3d{1, 0, 0}));
  return text + tables;
}

struct Course {
  PointArray plus_ends;
  Vec3d body;
  Vector6 motion;
};

Course course(std::string const& scene) {
  Simulation simulation(parse_scene(scene, "test.toml"));
  while (simulation.time() < 0.5) simulation.step(0.5);
  Course course{{}, simulation.bodies()[0].pose().position, simulation.bodies()[0].motion()};
  for (std::size_t i = 0; i < simulation.fibers().count(); ++i)
    course.plus_ends.push_back(plus_end(simulation.fibers().shape(i)));
  return course;
}

std::string const mechanisms[] = {
    "[pushing]\nsliding = \"none\"\n", "[pushing]\nsliding = \"free\"\n",
    "[pushing]\nsliding = \"friction\"\nfriction = 5.0\n",
    "[cortical_pulling]\npositions = SITES\ncapture_rate = 20.0\nposterior = AXIS\ndividing_body = \"ball\"\n",
    "[cytoplasmic_pulling]\n", "[cytoplasmic_pulling]\ncargo_offset = 0.5\n",
    "[pushing]\nsliding = \"none\"\n[steric_repulsion]\nrange = 0.5\n"};

void expect_image(Matrix3 const& image, Eigen::Quaterniond const& turn) {
  for (std::string const& mechanism : mechanisms) {
    Course const plain = course(scene_text(mechanism, Matrix3::Identity(), Eigen::Quaterniond::Identity()));
    Course const turned = course(scene_text(mechanism, image, turn));
    // GMRES to 1e-10 of velocities of 1 um/s, magnified by stiff contacts.
    EXPECT_LT(norm(turned.body - image * plain.body), 1e-8) << mechanism;
    EXPECT_GT(norm(plain.body - Vec3d{0.8, -0.3, 0.2}), 1e-4) << mechanism;
    Vec3d const spin = image.determinant() * (image * to_vec3(plain.motion.tail<3>()));  // a pseudovector
    EXPECT_LT(norm(to_vec3(turned.motion.tail<3>()) - spin), 1e-7) << mechanism;
    for (std::size_t i = 0; i < plain.plus_ends.size(); ++i)
      EXPECT_LT(norm(turned.plus_ends[i] - image * plain.plus_ends[i]), 1e-7) << mechanism << i;
  }
}

}  // namespace

TEST(MechanismSymmetry, a_turned_scene_goes_the_turned_way) {
  Eigen::Quaterniond const turn(Eigen::AngleAxisd(1.1, Eigen::Vector3d(0.3, -0.5, 0.8).normalized()));
  expect_image(turn.toRotationMatrix(), turn);
}

TEST(MechanismSymmetry, a_mirrored_scene_goes_the_mirrored_way) {
  expect_image(Eigen::Vector3d(1, -1, 1).asDiagonal(), Eigen::Quaterniond::Identity());
}

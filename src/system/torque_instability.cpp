#include "system/torque_instability.hpp"

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "linalg/quadrature.hpp"
#include "surface/shapes.hpp"

#include <Eigen/Geometry>
#include <numbers>

namespace asterflow {
namespace {

// One straight fiber, or a direction of the quadrature, with the body as the scene turns it.
struct Ray {
  Vec3d start;      // um, from the body's centre
  Vec3d direction;  // unit
  double weight;    // all together 1
};

struct Problem {
  Vec3d centre;        // um
  double radius = 0.0;  // um, a
  double angle = 0.0;  // radians, of the first aster's axis in the scene
  std::vector<Ray> continuum, fibers;
  std::shared_ptr<Shape const> periphery;
};

// Where a straight line from inside first meets the periphery. The distance d to it bounds the step from inside, and
// dd/ds = p . n gives Newton's method near it.
struct Meeting {
  double length;  // um
  Vec3d normal;
};

Meeting meet(Shape const& periphery, Vec3d start, Vec3d direction) {
  double const near = 0.05 * periphery.size();
  double length = 0.0;
  for (int step = 0; step < 10000; ++step) {
    ClosestPoint const wall = periphery.closest_point(start + length * direction);
    if (step == 0 && wall.distance >= 0.0) throw SceneError("[[aster]]: a fiber starts outside the periphery");
    double const slope = dot(direction, wall.normal);
    bool const is_close = std::abs(wall.distance) < near && slope > 0.05;
    length -= is_close ? wall.distance / slope : wall.distance;
    if (std::abs(wall.distance) < 1e-13 * periphery.size()) return {length, wall.normal};
  }
  throw NumericalError("[[aster]]: a fiber nearly touches the periphery along its side; its end cannot be found");
}

void add_fibers(Scene const& scene, AsterSpec const& aster, std::size_t number, double weight, std::vector<Ray>& rays) {
  for (auto const& fiber : aster_fibers(aster, aster.count, 0, scene.run.seed, number))
    rays.push_back({fiber.site.position, fiber.site.direction, weight / aster.count});
}

// Gauss-Legendre in the cosine of the angle from the axis, trapezoid about it: spectrally accurate.
void add_continuum(AsterSpec const& aster, double weight, std::vector<Ray>& rays) {
  constexpr int n_polar = 24, n_turn = 48;
  auto const& rule = gauss_legendre(n_polar);
  double const lowest = std::cos(aster.opening * std::numbers::pi / 180.0);
  Eigen::Vector3d const axis = to_eigen(aster.axis), first = axis.unitOrthogonal(), second = axis.cross(first);
  for (int i = 0; i < n_polar; ++i) {
    double const z = 0.5 * (1.0 + lowest) + 0.5 * (1.0 - lowest) * rule.nodes[i], r = std::sqrt(1.0 - z * z);
    for (int j = 0; j < n_turn; ++j) {
      double const turn = 2.0 * std::numbers::pi * (j + 0.5) / n_turn;
      Vec3d const direction = to_vec3(z * axis + r * (std::cos(turn) * first + std::sin(turn) * second));
      rays.push_back({aster.position + aster.centrosome_radius * direction, direction,
                      weight * 0.5 * rule.weights[i] / n_turn});
    }
  }
}

Problem problem_of(Scene const& scene) {
  auto const refuse = [&](std::string const& what) { throw SceneError(scene.file + ": " + what); };
  if (!scene.periphery) refuse("the torque instability needs a [periphery]");
  if (scene.bodies.empty()) refuse("the torque instability needs a [[body]]");
  if (scene.drag.body.empty() && scene.bodies.size() > 1) refuse("[drag]: body: must name one of the bodies");
  auto const& body = scene.bodies[scene.drag.body.empty() ? 0 : body_index(scene, scene.drag.body)];
  Problem problem;
  problem.centre = body.position;
  Matrix3 const orientation = body.orientation.toRotationMatrix();
  problem.radius = outer_radius(body.shape);
  problem.periphery = make_shape(scene.periphery->shape);
  int total = 0;
  for (auto const& aster : scene.asters)
    if (aster.body == body.name) total += aster.count;
  if (total == 0) refuse("[[aster]]: body \"" + body.name + "\" needs fibers to turn it");
  for (std::size_t number = 0; number < scene.asters.size(); ++number) {
    auto const& aster = scene.asters[number];
    if (aster.body != body.name || aster.count == 0) continue;
    if (problem.fibers.empty()) {
      Vec3d const axis = orientation * aster.axis;
      if (std::hypot(axis.x, axis.y) < 1e-6) refuse("[[aster]]: axis: along z has no angle to the x axis");
      problem.angle = std::atan2(axis.y, axis.x);
    }
    add_fibers(scene, aster, number, double(aster.count) / total, problem.fibers);
    add_continuum(aster, double(aster.count) / total, problem.continuum);
  }
  for (auto* rays : {&problem.fibers, &problem.continuum})
    for (Ray& ray : *rays) ray.start = orientation * ray.start, ray.direction = orientation * ray.direction;
  return problem;
}

TurningRates turning_rates(Problem const& problem, std::vector<Ray> const& rays, Matrix3 const& turn) {
  TurningRates rates;
  for (Ray const& ray : rays) {
    Vec3d const start = turn * ray.start, direction = turn * ray.direction;
    auto const [length, normal] = meet(*problem.periphery, problem.centre + start, direction);
    Vec3d const plus_end = start + length * direction;
    double const push = ray.weight * problem.radius / (length * length);
    rates.free_sliding -= push * cross(plus_end, normal).z;
    rates.no_sliding -= push * cross(plus_end, direction).z;
  }
  return rates;
}

}  // namespace

std::vector<TorquePoint> torque_instability(Scene const& scene, std::vector<double> const& angles) {
  Problem const problem = problem_of(scene);
  std::vector<TorquePoint> points(angles.size());
  parallel_for("torque_instability", static_cast<long>(angles.size()), [&](long i) {
    double const turned = angles[i] * std::numbers::pi / 180.0 - problem.angle;
    Matrix3 const turn = Eigen::AngleAxisd(turned, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    points[i] = {angles[i], turning_rates(problem, problem.continuum, turn),
                 turning_rates(problem, problem.fibers, turn)};
  });
  return points;
}

}  // namespace asterflow

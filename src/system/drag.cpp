#include "system/drag.hpp"

#include "base/error.hpp"
#include "base/timer.hpp"
#include "system/simulation.hpp"

#include <cmath>

namespace asterflow {
namespace {

enum class Pull { force, torque };

// Its force and torque alone move it.
std::size_t studied_body(Scene const& scene) {
  auto const refuse = [&](std::string const& what) { throw SceneError(scene.file + ": " + what); };
  if (scene.bodies.empty()) refuse("[drag]: needs a [[body]]");
  if (scene.drag.body.empty() && scene.bodies.size() > 1) refuse("[drag]: body: must name one of the bodies");
  int const body = scene.drag.body.empty() ? 0 : body_index(scene, scene.drag.body);
  if (scene.bodies[body].motion != BodySpec::Motion::free)
    refuse("[[body]] \"" + scene.bodies[body].name + "\": motion: must be \"free\" for its drag to be studied");
  if (scene.background) refuse("[background]: moves bodies without force; a drag is studied in fluid at rest");
  for (int const count : scene.drag.fiber_counts)
    if (count > 0 && scene.asters.empty()) refuse("[drag]: fiber_counts: needs an [[aster]] to hold the fibers");
  return static_cast<std::size_t>(body);
}

// The scene of one point: asters share the fibers evenly, and one load acts.
Scene scene_of(Scene scene, std::size_t body, Interactions level, int fiber_count, Pull pull) {
  scene.run.interactions = level;
  int rest = fiber_count;
  for (std::size_t i = 0; i < scene.asters.size(); ++i) {
    int const share = rest / static_cast<int>(scene.asters.size() - i);
    scene.asters[i].count = share;
    rest -= share;
  }
  scene.bodies[body].force = pull == Pull::force ? scene.drag.force : Vec3d{};
  scene.bodies[body].torque = pull == Pull::torque ? scene.drag.torque : Vec3d{};
  return scene;
}

struct Measurement {
  double drag = 0.0, spread = 0.0;
  long iterations = 0, inner_iterations = 0;
  int steps = 0;
};

Measurement measure(Scene const& scene, std::size_t body, Pull pull, std::function<void(double)> const& progress) {
  auto const& drag = scene.drag;
  Vec3d const load = pull == Pull::force ? drag.force : drag.torque;
  Vec3d const along = normalized(load);
  int const part = pull == Pull::force ? 0 : 3;
  Simulation simulation(scene);
  Measurement result;
  double const end = drag.settling_time + drag.duration;
  auto const advance_to = [&](double time, double& displacement) {
    while (simulation.time() < time) {
      auto const report = simulation.step(time);
      auto const& motion = simulation.bodies()[body].motion();
      displacement += report.dt * dot(to_vec3(motion.segment<3>(part)), along);
      result.iterations += report.iterations;
      result.inner_iterations += report.inner_iterations;
      ++result.steps;
      progress(simulation.time() / end);
    }
  };
  double ignored = 0.0, sum = 0.0, sum_of_squares = 0.0;
  advance_to(drag.settling_time, ignored);
  auto const& spec = scene.bodies[body];
  RigidPose const pose{{}, spec.orientation.toRotationMatrix()};
  Matrix6 const alone = simulation.resistance_alone(body, pose);
  double const gamma = to_eigen(along).dot(alone.block<3, 3>(part, part) * to_eigen(along));
  for (int sample = 1; sample <= drag.samples; ++sample) {
    double displacement = 0.0;
    double const begin = simulation.time();
    advance_to(drag.settling_time + drag.duration * sample / drag.samples, displacement);
    double const velocity = displacement / (simulation.time() - begin);
    sum += velocity;
    sum_of_squares += velocity * velocity;
  }
  double const mean = sum / drag.samples;
  double const variance = std::max(0.0, sum_of_squares / drag.samples - mean * mean);
  result.drag = norm(load) / (gamma * mean);
  result.spread = result.drag * std::sqrt(variance) / std::abs(mean);
  return result;
}

}  // namespace

void drag_study(Scene const& scene, std::function<bool(Interactions, int)> const& is_known,
                std::function<void(DragPoint const&)> const& done,
                std::function<void(DragPoint const&, double)> const& progress) {
  std::size_t const body = studied_body(scene);
  for (Interactions const level : scene.drag.levels)
    for (int const count : scene.drag.fiber_counts) {
      if (is_known(level, count)) continue;
      Timer const timer;
      DragPoint point;
      point.level = level;
      point.fiber_count = count;
      auto const translation = measure(scene_of(scene, body, level, count, Pull::force), body, Pull::force,
                                       [&](double part) { progress(point, 0.5 * part); });
      auto const rotation = measure(scene_of(scene, body, level, count, Pull::torque), body, Pull::torque,
                                    [&](double part) { progress(point, 0.5 + 0.5 * part); });
      point.translation = translation.drag;
      point.translation_spread = translation.spread;
      point.rotation = rotation.drag;
      point.rotation_spread = rotation.spread;
      point.steps = translation.steps + rotation.steps;
      point.iterations = static_cast<double>(translation.iterations + rotation.iterations) / point.steps;
      point.inner_iterations = static_cast<double>(translation.inner_iterations + rotation.inner_iterations) / point.steps;
      point.seconds = timer.seconds();
      done(point);
    }
}

}  // namespace asterflow

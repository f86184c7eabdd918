#include "observable/body_observables.hpp"

#include "io/frame.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace asterflow {
namespace {

void add_vector(std::string const& name, Vec3d value, Observables& row) {
  for (int k = 0; k < 3; ++k) row.push_back({name + "_" + "xyz"[k], value[k]});
}

}  // namespace

Observables body_observables(Scene const& scene, Frame const& frame) {
  Observables row;
  auto const positions = points_of(frame, "body/position");
  auto const orientations = orientations_of(frame);
  auto const velocities = points_of(frame, "body/velocity"), turning = points_of(frame, "body/angular_velocity");
  auto const forces = points_of(frame, "body/applied_force"), torques = points_of(frame, "body/applied_torque");
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    auto const& name = scene.bodies[b].name;
    add_vector(name, positions.at(b), row);
    auto const aster = std::find_if(scene.asters.begin(), scene.asters.end(),
                                    [&](AsterSpec const& a) { return a.body == name; });
    if (aster != scene.asters.end()) {
      Vec3d const axis = orientations.at(b).toRotationMatrix() * aster->axis;
      double const angle = std::atan2(std::hypot(axis.y, axis.z), std::abs(axis.x));
      row.push_back({name + "_angle", angle * 180.0 / std::numbers::pi});
    }
    add_vector(name + "_velocity", velocities.at(b), row);
    row.push_back({name + "_speed", norm(velocities.at(b))});
    add_vector(name + "_angular_velocity", turning.at(b), row);
    row.push_back({name + "_angular_speed", norm(turning.at(b))});
    if (scene.bodies[b].motion == BodySpec::Motion::free) continue;
    // Unknown before the first step and in states stored before these loads were.
    bool const is_known = frame.time > 0.0 && b < forces.size() && b < torques.size();
    Vec3d const unknown = std::nan("") * Vec3d{1.0, 1.0, 1.0};
    add_vector(name + "_force", is_known ? forces[b] : unknown, row);
    add_vector(name + "_torque", is_known ? torques[b] : unknown, row);
  }
  return row;
}

}  // namespace asterflow

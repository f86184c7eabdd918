#pragma once
// Convergence in the time step, for tests.

#include "base/vec3.hpp"
#include "system/simulation.hpp"

#include <cmath>
#include <string>

namespace asterflow::test {

// Changes by halving the step, and the order that they show.
struct Convergence {
  double coarse, fine, order;
};

// place(dt): a point that depends on the step; the steps h, h / 2 and, `halvings` times halved, those again.
template <class Place>
Convergence convergence_in_time(Place const& place, double h, int halvings) {
  auto const change = [&](double dt) { return norm(place(dt) - place(dt / 2)); };
  double const coarse = change(h), fine = change(std::ldexp(h, -halvings));
  return {coarse, fine, std::log2(coarse / fine) / halvings};
}

// Where the first body of a scene is at a time, s; the scene ends with its [run] table and gets equal steps.
inline Vec3d body_after(double time, std::string const& scene, double dt) {
  Simulation simulation(parse_scene(scene + "\nadaptive = false\ntime_step = " + std::to_string(dt), "t.toml"));
  while (simulation.time() < time) simulation.step(time);
  return simulation.bodies()[0].pose().position;
}

}  // namespace asterflow::test

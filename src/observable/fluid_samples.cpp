#include "observable/fluid_samples.hpp"

#include "base/polar_directions.hpp"
#include "base/rigid.hpp"
#include "io/frame.hpp"
#include "io/scene_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace asterflow {
namespace {

constexpr int n_spread = 400;
constexpr double margin = 0.3;    // um, to the surfaces

// The additive sequence with the roots of x^4 = x + 1, evenly spread in the unit cube.
Vec3d evenly_spread(int i) {
  constexpr double g = 1.2207440846057596;
  auto const fraction = [](double x) { return x - std::floor(x); };
  return {fraction(0.5 + i / g), fraction(0.5 + i / (g * g)), fraction(0.5 + i / (g * g * g))};
}

// Lines along x beside the body's axis, from its surface to the periphery or two radii further.
PointArray cylinder(PlacedScene const& placed, double side) {
  PointArray points;
  if (placed.bodies.empty()) return points;
  Vec3d const centre = placed.bodies.front().position();
  double const radius = placed.bodies.front().size(), step = 0.1 * radius;
  for (int line = 0; line < 5; ++line) {
    double const offset = line == 0 ? 0.0 : 0.5 * radius, turn = 0.5 * std::numbers::pi * line;
    for (int i = 1; i * step < (placed.periphery ? 100.0 : 3.0) * radius; ++i) {
      Vec3d const x = centre + Vec3d{side * i * step, offset * std::cos(turn), offset * std::sin(turn)};
      if (placed.periphery && placed.periphery->signed_distance(x) > -margin) break;
      if (placed.clearance(x) > margin) points.push_back(x);
    }
  }
  return points;
}

void add_beside_fibers(StoredFibers const& fibers, PlacedScene const& placed, FluidSamples& samples) {
  constexpr double offset = 0.75;
  std::size_t const stride = fibers.position.size() / n_spread + 1;
  for (std::size_t i = 0; i < fibers.count(); ++i) {
    Vec3d const direction = normalized(fibers.plus_end[i] - fibers.minus_end[i]);
    Eigen::Vector3d const axis = to_eigen(direction), first = axis.unitOrthogonal(), second = axis.cross(first);
    for (auto k = fibers.first[i]; k < fibers.first[i + 1]; ++k) {
      if (k % static_cast<std::int64_t>(stride) != 0) continue;
      double const turn = golden_angle * static_cast<double>(k);
      Vec3d const x = fibers.position[k] + offset * to_vec3(std::cos(turn) * first + std::sin(turn) * second);
      if (placed.clearance(x) < margin) continue;
      samples.beside_fibers.push_back(x);
      samples.fiber_directions.push_back(direction);
    }
  }
}

}  // namespace

FluidSamples fluid_samples(Scene const& scene, Frame const& frame, StoredFibers const& fibers) {
  PlacedScene const placed(bodies_at(scene.bodies, frame), scene.periphery ? &scene.periphery->shape : nullptr);
  Vec3d const centre = placed.periphery || placed.bodies.empty() ? Vec3d{} : placed.bodies.front().position();
  double const reach = placed.periphery         ? placed.periphery->size()
                       : placed.bodies.empty() ? 10.0
                                               : 4.0 * placed.bodies.front().size();
  FluidSamples samples;
  for (int i = 0; i < 100 * n_spread && static_cast<int>(samples.spread.size()) < n_spread; ++i) {
    Vec3d const x = reach * (2.0 * evenly_spread(i) - Vec3d{1.0, 1.0, 1.0});
    if (norm(x) < reach && placed.clearance(centre + x) > margin) samples.spread.push_back(centre + x);
  }
  samples.anterior = cylinder(placed, -1.0);
  samples.posterior = cylinder(placed, 1.0);
  add_beside_fibers(fibers, placed, samples);
  return samples;
}

}  // namespace asterflow

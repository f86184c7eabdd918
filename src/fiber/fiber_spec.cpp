#include "fiber/fiber_spec.hpp"

#include "base/polar_directions.hpp"
#include "base/random.hpp"
#include "fiber/fiber_basis.hpp"
#include "fiber/fitted_centreline.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace asterflow {

namespace {

void read_material(Table& table, FiberMaterialSpec& material) {
  table.read("bending_rigidity", material.bending_rigidity, positive, "pN um^2");
  table.read("radius", material.radius, positive, "um");
  table.read("nodes", material.nodes, between(min_fiber_nodes, max_fiber_nodes));
  table.read_choice<MinusEnd>("minus_end", material.minus_end,
                              {{"free", MinusEnd::free}, {"hinged", MinusEnd::hinged}, {"clamped", MinusEnd::clamped}});
  table.read("growing", material.growing);
  table.read("nonlocal", material.nonlocal);
}

void read_direction(Table& table, char const* key, Vec3d& direction) {
  table.read(key, direction);
  if (norm(direction) == 0.0) table.fail(key, "must not be zero");
  direction = normalized(direction);
}

// The bound of slender-body theory that the local mobility needs (see slender_body_mobility).
void check_slenderness(Table const& table, double length, double radius) {
  if (radius > 0.25 * length) table.fail("radius", "must be at most a quarter of the fiber's length (um)");
}

double length_of(std::vector<Vec3d> const& points) {
  double length = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) length += norm(points[i] - points[i - 1]);
  return length;
}

void check_points(Table const& table, std::vector<Vec3d> const& points) {
  if (points.size() < 2) table.fail("points", "needs at least two points (um)");
  for (std::size_t i = 1; i < points.size(); ++i)
    if (norm(points[i] - points[i - 1]) == 0.0) table.fail("points", "must not repeat a point (um)");
}

// Growing and shrinking fibers that turn back at the cortex (b) and are renucleated at their least length (a) have, in
// the long run, lengths of the density exp(-k l) on [a, b] [Dogterom & Leibler 1993]: chance = its integral from a to l.
double steady_length(double a, double b, double k, double chance) {
  double const part = -std::expm1(-k * (b - a));
  return std::abs(part) < 1e-9 ? a + chance * (b - a) : a - std::log1p(-chance * part) / k;
}

double random_length(AsterSpec const& aster, double chance) {
  double const spread = aster.length - aster.minimal_length;
  switch (aster.lengths) {
    case AsterSpec::Lengths::uniform:
      return aster.minimal_length + 2 * spread * chance;
    case AsterSpec::Lengths::exponential:
      return aster.minimal_length - spread * std::log(chance);
    default:
      return aster.length;
  }
}

}  // namespace

FiberSpec read_fiber(Table table) {
  FiberSpec fiber;
  read_material(table, fiber.material);
  table.read("points", fiber.points, any_number, "um");
  table.read("position", fiber.position, any_number, "um");
  read_direction(table, "direction", fiber.direction);
  table.read("length", fiber.length, positive, "um");
  table.read("body", fiber.body);
  table.read("end_force", fiber.end_force, any_number, "pN");
  table.read("force_density", fiber.force_density, any_number, "pN/um");
  if (table.has("points")) {
    for (char const* key : {"position", "direction", "length"})
      if (table.has(key)) table.fail(key, "does not go together with points");
    check_points(table, fiber.points);
    fiber.position = fiber.points.front();
    fiber.direction = normalized(fiber.points[1] - fiber.points[0]);
    fiber.length = length_of(fiber.points);
  }
  if (table.has("body") && fiber.material.minus_end == MinusEnd::free)
    table.fail("body", "needs minus_end = \"clamped\" or \"hinged\"");
  check_slenderness(table, fiber.length, fiber.material.radius);
  table.finish();
  return fiber;
}

PointArray points_along(FiberSpec const& fiber) {
  constexpr int n_between = 31;
  if (!fiber.points.empty()) return points_between(fiber.points, n_between);
  PointArray const ends{fiber.position, fiber.position + fiber.length * fiber.direction};
  return points_between(ends, n_between);
}

AsterSpec read_aster(Table table) {
  AsterSpec aster;
  read_material(table, aster.material);
  if (aster.material.minus_end == MinusEnd::free) table.fail("minus_end", "must be \"clamped\" or \"hinged\"");
  table.read("body", aster.body);
  table.read("position", aster.position, any_number, "um");
  if (norm(aster.position) > 0.0) aster.axis = aster.position;
  read_direction(table, "axis", aster.axis);
  table.read("centrosome_radius", aster.centrosome_radius, not_negative, "um");
  table.read("opening", aster.opening, between(0.0, 180.0), "degrees");
  table.read("count", aster.count, between(0, 1000000));
  using Arrangement = AsterSpec::Arrangement;
  table.read_choice<Arrangement>("arrangement", aster.arrangement,
                                 {{"random", Arrangement::random}, {"even", Arrangement::even}});
  using Lengths = AsterSpec::Lengths;
  table.read_choice<Lengths>(
      "lengths", aster.lengths,
      {{"equal", Lengths::equal}, {"uniform", Lengths::uniform}, {"exponential", Lengths::exponential},
       {"steady", Lengths::steady}});
  table.read("minimal_length", aster.minimal_length, positive, "um");
  table.read("length", aster.length, positive, "um");
  if (aster.length < aster.minimal_length) table.fail("length", "must be at least minimal_length (um)");
  check_slenderness(table, aster.minimal_length, aster.material.radius);
  table.finish();
  return aster;
}

std::vector<AsterFiber> aster_fibers(AsterSpec const& aster, int count, int body, std::uint64_t seed,
                                     std::uint64_t number, std::function<double(MinusEndSite const&)> const& reach,
                                     double decay) {
  PolarDirections const at(aster.axis);
  double const lowest = std::cos(aster.opening * std::numbers::pi / 180.0);
  bool const is_even = aster.arrangement == AsterSpec::Arrangement::even;
  std::uint64_t const stream = mix_bits(0x6173746572ull + number);  // keeps asters apart from fibers' own chance
  std::vector<AsterFiber> fibers(count);
  for (int i = 0; i < count; ++i) {
    double const height = is_even ? (i + 0.5) / count : uniform_random(seed, stream, i, 0);
    double const turn = is_even ? golden_angle * i : 2 * std::numbers::pi * uniform_random(seed, stream, i, 1);
    Vec3d const direction = normalized(at(lowest + (1.0 - lowest) * height, turn));
    fibers[i].site = {aster.material.minus_end, body, aster.position + aster.centrosome_radius * direction, direction};
    double const chance = uniform_random(seed, stream, i, 2);
    fibers[i].length = random_length(aster, chance);
    if (!reach) continue;
    double const longest = std::max(aster.minimal_length, reach(fibers[i].site));
    fibers[i].length = aster.lengths == AsterSpec::Lengths::steady
                           ? steady_length(aster.minimal_length, longest, decay, chance)
                           : std::min(fibers[i].length, longest);
  }
  return fibers;
}

}  // namespace asterflow

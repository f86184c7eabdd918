#include "io/scene_checks.hpp"

#include "io/scene_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace asterflow {

namespace {

constexpr double touching = 1e-6;  // um: what is closer to a surface counts as on it

void check_body_reference(Table const& table, Scene const& scene, std::string const& name,
                          std::string_view key = "body") {
  if (name.empty()) return;
  std::vector<std::string> known;
  for (auto const& body : scene.bodies) known.push_back(body.name);
  if (std::find(known.begin(), known.end(), name) != known.end()) return;
  if (known.empty()) table.fail(key, "the scene has no [[body]]");
  table.fail(key, fmt::format("must be the name of a [[body]] (known: {})", fmt::join(known, ", ")));
}

void check_bodies(SceneTables const& tables, Scene const& scene, PlacedScene const& placed) {
  for (std::size_t i = 0; i < placed.bodies.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j)
      if (gap_between(placed.bodies[j], placed.bodies[i]) <= 0.0)
        tables.bodies[i].fail(
            fmt::format("overlaps [[body]] #{} \"{}\"; move one of them", j + 1, scene.bodies[j].name));
    if (placed.periphery && gap_inside(placed.bodies[i], *placed.periphery) <= 0.0)
      tables.bodies[i].fail("reaches outside the periphery; move it inwards or make it smaller");
  }
}

void check_fiber(Table const& table, Scene const& scene, FiberSpec const& fiber, PlacedScene const& placed) {
  for (Vec3d const& x : points_along(fiber)) {
    std::string const place = fmt::format("at [{:g}, {:g}, {:g}] um", x.x, x.y, x.z);
    if (placed.periphery && placed.periphery->signed_distance(x) > touching)
      table.fail(fmt::format("reaches outside the periphery {}; move or shorten it", place));
    for (std::size_t b = 0; b < placed.bodies.size(); ++b)
      if (placed.bodies[b].signed_distance(x) < -touching)
        table.fail(fmt::format("passes through [[body]] #{} \"{}\" {}; move or shorten it", b + 1, scene.bodies[b].name,
                               place));
  }
}

void check_aster(Table const& table, Scene const& scene, AsterSpec const& aster, std::size_t number,
                 PlacedScene const& placed) {
  int const b = body_index(scene, aster.body);
  auto const fibers = aster_fibers(aster, aster.count, b, scene.run.seed, number);
  for (std::size_t i = 0; i < fibers.size(); ++i) {
    Vec3d const x = b < 0 ? fibers[i].site.position : placed.bodies[b].to_laboratory(fibers[i].site.position);
    Vec3d const d = b < 0 ? fibers[i].site.direction : placed.bodies[b].turn_to_laboratory(fibers[i].site.direction);
    if (placed.clearance(x) < -touching || placed.reach(x, d, aster.minimal_length) < aster.minimal_length)
      table.fail(fmt::format("fiber {} from [{:g}, {:g}, {:g}] um has no room for minimal_length = {:g} um before a body or "
                             "the periphery; move the aster, or reduce its opening or centrosome_radius",
                             i + 1, x.x, x.y, x.z, aster.minimal_length));
  }
}

}  // namespace

void check_names(SceneTables const& tables, Scene const& scene) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (scene.bodies[i].name == scene.bodies[j].name)
        tables.bodies[i].fail("name", fmt::format("is the name of [[body]] #{} too", j + 1));
  for (std::size_t i = 0; i < scene.fibers.size(); ++i)
    check_body_reference(tables.fibers[i], scene, scene.fibers[i].body);
  for (std::size_t i = 0; i < scene.asters.size(); ++i)
    check_body_reference(tables.asters[i], scene, scene.asters[i].body);
  check_body_reference(tables.drag, scene, scene.drag.body);
}

// Lengths that grow without bound have no steady state.
void check_steady_lengths(SceneTables const& tables, Scene const& scene) {
  bool const is_bounded = scene.periphery && scene.dynamic_instability;
  for (std::size_t i = 0; i < scene.asters.size(); ++i)
    if (scene.asters[i].lengths == AsterSpec::Lengths::steady && !(is_bounded && scene.asters[i].material.growing))
      tables.asters[i].fail("lengths", "\"steady\" needs growing = true and tables [dynamic_instability] and [periphery]");
}

// check(table, fiber or aster) for all of the scene.
template <class Check>
void for_fibers_and_asters(SceneTables const& tables, Scene const& scene, Check const& check) {
  for (std::size_t i = 0; i < scene.fibers.size(); ++i) check(tables.fibers[i], scene.fibers[i]);
  for (std::size_t i = 0; i < scene.asters.size(); ++i) check(tables.asters[i], scene.asters[i]);
}

void check_growth(SceneTables const& tables, Scene const& scene) {
  check_steady_lengths(tables, scene);
  for_fibers_and_asters(tables, scene, [&](Table const& table, auto const& one) {
    if (!one.material.growing) return;
    if (!scene.dynamic_instability) table.fail("growing", "needs a table [dynamic_instability]");
    double const shortest = scene.dynamic_instability->minimal_length;  // to which they shrink before they start again
    if (one.material.radius > 0.25 * shortest)
      table.fail("radius", fmt::format("must be at most a quarter of minimal_length = {:g} um of [dynamic_instability]", shortest));
  });
}

void check_nonlocal(SceneTables const& tables, Scene const& scene) {
  if (scene.run.interactions != Interactions::local) return;
  for_fibers_and_asters(tables, scene, [](Table const& table, auto const& one) {
    if (one.material.nonlocal)
      table.fail("nonlocal", "needs interactions = \"open\" or \"confined\"; with \"local\" drag is local");
  });
}

// What plus ends do at the cortex needs a cortex and plus ends that grow.
void check_cortex_mechanisms(SceneTables const& tables, Scene const& scene, bool has_growing_fibers) {
  for (auto const& table : {tables.pushing, tables.cortical_pulling}) {
    if (!table) continue;
    if (!scene.periphery) table->fail("needs a table [periphery]: the cortex");
    if (!scene.dynamic_instability || !has_growing_fibers) table->fail("needs a table [dynamic_instability] and fibers with growing = true");
  }
}

// Springs follow from the radius of the body that holds a fiber.
void check_springs(SceneTables const& tables, Scene const& scene) {
  if (!scene.pushing || scene.pushing->sliding == PushingSpec::Sliding::free || scene.pushing->spring_stiffness) return;
  for_fibers_and_asters(tables, scene, [&](Table const&, auto const& one) {
    if (one.material.growing && one.body.empty())
      tables.pushing->fail("spring_stiffness", "is needed: it follows from the radius of the body only for fibers on a body");
  });
}

void check_sites(SceneTables const& tables, Scene const& scene) {
  if (!scene.cortical_pulling) return;
  check_body_reference(*tables.cortical_pulling, scene, scene.cortical_pulling->dividing_body, "dividing_body");
  PlacedShape const cortex(scene.periphery->shape);
  for (Vec3d const& x : scene.cortical_pulling->positions)
    if (double const d = cortex.signed_distance(x); std::abs(d) > 0.1)
      tables.cortical_pulling->fail(
          "positions", fmt::format("[{:g}, {:g}, {:g}] um lies {:.3g} um {} the cortex; sites lie on it (within 0.1 um)", x.x,
                                   x.y, x.z, std::abs(d), d > 0 ? "outside" : "inside"));
}

void check_repelled_objects(SceneTables const& tables, Scene const& scene, bool has_fibers) {
  if (!scene.steric_repulsion) return;
  auto const& repulsion = *scene.steric_repulsion;
  bool const has_cortex = scene.periphery.has_value(), has_bodies = !scene.bodies.empty();
  bool const acts = (repulsion.fiber_cortex && has_fibers && has_cortex) || (repulsion.fiber_body && has_fibers && has_bodies) ||
                    (repulsion.body_cortex && has_bodies && has_cortex) || (repulsion.body_body && scene.bodies.size() > 1);
  if (!acts)
    tables.steric_repulsion->fail(
        "has nothing to repel: fiber_cortex needs fibers and a [periphery], fiber_body fibers and a [[body]], body_cortex a "
        "[[body]] and a [periphery], body_body two [[body]]");
}

// What happens near the cortex happens within a part of the cell.
void check_ranges(SceneTables const& tables, Scene const& scene) {
  if (!scene.periphery) return;
  double const cell = PlacedShape(scene.periphery->shape).least_radius();
  if (scene.steric_repulsion && scene.steric_repulsion->range >= cell)
    tables.steric_repulsion->fail("range", fmt::format("must be less than {:g} um, the least radius of the periphery", cell));
  if (!scene.dynamic_instability) return;
  double const margin = scene.dynamic_instability->cortex_margin;
  if (margin >= cell)
    tables.dynamic_instability->fail("cortex_margin",
                                     fmt::format("must be less than {:g} um, the least radius of the periphery", cell));
  if (scene.dynamic_instability->minimal_length >= cell)
    tables.dynamic_instability->fail("minimal_length",
                                     fmt::format("must be less than {:g} um, the least radius of the periphery", cell));
  if (scene.pushing && scene.pushing->range >= cell - margin)
    tables.pushing->fail("range", fmt::format("must be less than {:g} um, the least radius of the periphery without cortex_margin",
                                              cell - margin));
}

void check_mechanisms(SceneTables const& tables, Scene const& scene) {
  bool has_fibers = false, has_growing_fibers = false;
  for_fibers_and_asters(tables, scene, [&](Table const&, auto const& one) {
    has_fibers = true;
    has_growing_fibers |= one.material.growing;
  });
  check_cortex_mechanisms(tables, scene, has_growing_fibers);
  if (scene.cytoplasmic_pulling && !has_fibers) tables.cytoplasmic_pulling->fail("needs a [[fiber]] or an [[aster]] to pull");
  check_springs(tables, scene);
  check_sites(tables, scene);
  check_repelled_objects(tables, scene, has_fibers);
  check_ranges(tables, scene);
}

void check_places(SceneTables const& tables, Scene const& scene) {
  PlacedScene const placed(scene.bodies, scene.periphery ? &scene.periphery->shape : nullptr);
  check_bodies(tables, scene, placed);
  for (std::size_t i = 0; i < scene.fibers.size(); ++i) check_fiber(tables.fibers[i], scene, scene.fibers[i], placed);
  for (std::size_t i = 0; i < scene.asters.size(); ++i) check_aster(tables.asters[i], scene, scene.asters[i], i, placed);
}

}  // namespace asterflow

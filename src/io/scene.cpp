#include "io/scene.hpp"

#include "io/scene_checks.hpp"

#include <stdexcept>

namespace asterflow {

namespace {

Scene read_all(Table root) {
  Scene scene;
  scene.file = root.file();
  scene.text = root.text();
  scene.overrides = root.overrides();

  auto const periphery = root.find_table("periphery");
  auto const background = root.find_table("background");
  SceneTables const tables{.bodies = root.tables("body"),
                           .fibers = root.tables("fiber"),
                           .asters = root.tables("aster"),
                           .drag = root.table("drag"),
                           .dynamic_instability = root.find_table("dynamic_instability"),
                           .cytoplasmic_pulling = root.find_table("cytoplasmic_pulling"),
                           .pushing = root.find_table("pushing"),
                           .cortical_pulling = root.find_table("cortical_pulling"),
                           .steric_repulsion = root.find_table("steric_repulsion")};
  Table const fluid = root.table("fluid"), run = root.table("run"), output = root.table("output");
  root.finish();

  scene.fluid = read_fluid(fluid);
  scene.output = read_output(output);
  scene.drag = read_drag(tables.drag);
  if (periphery) scene.periphery = read_periphery(*periphery);
  if (background) scene.background = read_background(*background);
  if (tables.dynamic_instability) scene.dynamic_instability = read_dynamic_instability(*tables.dynamic_instability);
  if (tables.cytoplasmic_pulling) scene.cytoplasmic_pulling = read_cytoplasmic_pulling(*tables.cytoplasmic_pulling);
  if (tables.pushing) scene.pushing = read_pushing(*tables.pushing);
  if (tables.cortical_pulling) scene.cortical_pulling = read_cortical_pulling(*tables.cortical_pulling);
  if (tables.steric_repulsion) scene.steric_repulsion = read_steric_repulsion(*tables.steric_repulsion);
  scene.run = read_run(run, periphery.has_value(), scene.steric_repulsion && scene.steric_repulsion->fiber_body);
  for (auto const& body : tables.bodies) scene.bodies.push_back(read_body(body, scene.bodies.size() + 1));
  for (auto const& fiber : tables.fibers) scene.fibers.push_back(read_fiber(fiber));
  for (auto const& aster : tables.asters) scene.asters.push_back(read_aster(aster));

  if (background && scene.run.interactions == Interactions::confined)
    background->fail("is a flow in unbounded fluid and cannot be combined with interactions = \"confined\"");
  check_names(tables, scene);
  check_growth(tables, scene);
  check_nonlocal(tables, scene);
  check_mechanisms(tables, scene);
  check_places(tables, scene);
  return scene;
}

}  // namespace

int body_index(Scene const& scene, std::string const& name) {
  if (name.empty()) return -1;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    if (scene.bodies[i].name == name) return static_cast<int>(i);
  throw std::out_of_range("no body is named " + name);
}

Scene read_scene(std::string const& file, std::vector<std::string> const& overrides) {
  return read_all(read_table(file, overrides));
}

Scene parse_scene(std::string const& text, std::string const& file, std::vector<std::string> const& overrides) {
  return read_all(parse_table(text, file, overrides));
}

}  // namespace asterflow

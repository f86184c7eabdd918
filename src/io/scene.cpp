#include "io/scene.hpp"

#include "base/error.hpp"
#include "io/scene_geometry.hpp"

#include <fmt/format.h>
#include <map>

namespace asterflow {

namespace {

void check_names(std::vector<Table> const& tables, std::vector<BodySpec> const& bodies) {
  std::map<std::string, std::size_t> first;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (auto const [other, is_new] = first.emplace(bodies[i].name, i); !is_new)
      tables[i].fail("name", fmt::format("is the name of [[body]] #{} too", other->second + 1));
}

// Bodies neither overlap nor leave the periphery.
void check_places(std::vector<Table> const& tables, Scene const& scene) {
  std::vector<PlacedShape> placed;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    placed.emplace_back(scene.bodies[i]);
    for (std::size_t j = 0; j < i; ++j)
      if (gap_between(placed[j], placed[i]) <= 0.0)
        tables[i].fail(fmt::format("overlaps [[body]] #{} \"{}\"; move one of them", j + 1, scene.bodies[j].name));
    if (scene.periphery && gap_inside(placed[i], PlacedShape(scene.periphery->shape)) <= 0.0)
      tables[i].fail("reaches outside the periphery; move it inwards or make it smaller");
  }
}

Scene read_all(Table root) {
  Scene scene;
  scene.file = root.file();
  scene.text = root.text();
  scene.overrides = root.overrides();

  auto const periphery = root.find_table("periphery");
  auto const background = root.find_table("background");
  auto const bodies = root.tables("body");
  Table const fluid = root.table("fluid"), run = root.table("run"), output = root.table("output"),
              drag = root.table("drag");
  root.finish();

  scene.fluid = read_fluid(fluid);
  if (periphery) scene.periphery = read_periphery(*periphery);
  if (background) scene.background = read_background(*background);
  for (auto const& body : bodies) scene.bodies.push_back(read_body(body, scene.bodies.size() + 1));
  check_names(bodies, scene.bodies);
  check_places(bodies, scene);
  scene.run = read_run(run, periphery.has_value());
  if (background && scene.run.interactions == Interactions::confined)
    background->fail("is a flow in unbounded fluid and cannot be combined with interactions = \"confined\"");
  scene.output = read_output(output);
  scene.drag = read_drag(drag);
  return scene;
}

}  // namespace

Scene read_scene(std::string const& file, std::vector<std::string> const& overrides) {
  return read_all(read_table(file, overrides));
}

Scene parse_scene(std::string const& text, std::string const& file, std::vector<std::string> const& overrides) {
  return read_all(parse_table(text, file, overrides));
}

}  // namespace asterflow

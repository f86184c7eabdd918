#include "command/mobility.hpp"

#include "base/error.hpp"
#include "command/json.hpp"
#include "io/scene.hpp"
#include "system/mobility.hpp"

#include <fmt/format.h>
#include <memory>

namespace asterflow {

namespace {

struct MobilityOptions {
  std::string scene;
  std::vector<std::string> overrides;
};

void print_mobility(MobilityOptions const& options) {
  Scene const scene = read_scene(options.scene, options.overrides);
  if (scene.bodies.empty()) throw SceneError(options.scene + ": has no [[body]], so no resistance or mobility");
  SceneMobility const result = scene_mobility(scene);
  std::string bodies;
  for (std::size_t b = 0; b < result.names.size(); ++b) {
    auto const i = static_cast<Eigen::Index>(6 * b);
    bodies += fmt::format("{}{{\"name\": {}, \"resistance\": {}, \"mobility\": {}}}", b > 0 ? ", " : "",
                          json_text(result.names[b]), json_matrix(result.resistance.block(i, i, 6, 6)),
                          json_matrix(result.mobility.block(i, i, 6, 6)));
  }
  std::string together;
  if (result.names.size() > 1)
    together = fmt::format(", \"resistance\": {}, \"mobility\": {}", json_matrix(result.resistance),
                           json_matrix(result.mobility));
  std::string const error = result.error > 0.0 ? fmt::format(", \"error\": {}", json_number(result.error)) : "";
  fmt::print("{{\"bodies\": [{}]{}, \"interactions\": {}, \"viscosity\": {}{}, \"units\": {}}}\n", bodies, together,
             json_text(std::string(name_of(scene.run.interactions))), json_number(scene.fluid.viscosity), error,
             json_text("um, s, pN"));
  if (result.error > scene.run.accuracy)
    fmt::print(stderr, "note: the estimated error {:.1e} exceeds accuracy = {:g}\n", result.error, scene.run.accuracy);
}

}  // namespace

void add_mobility_command(CLI::App& program, Action& chosen) {
  auto const options = std::make_shared<MobilityOptions>();
  auto* const command = program.add_subcommand(
      "mobility",
      "The 6 x 6 resistance and mobility matrices of every body in the scene as it stands, as JSON on stdout:\n"
      "  (force, torque about the centre) = resistance (velocity, angular velocity), the other bodies held still;\n"
      "  (velocity, angular velocity) = mobility (force, torque), the other bodies free.\n"
      "Several bodies: also the matrices of all together, in the order of the scene. Units um, s, pN. Without\n"
      "fibers `error` is the estimated relative error of the matrices.");
  command->add_option("scene", options->scene, "scene file (TOML)")->required();
  add_overrides(*command, options->overrides);
  command->footer(examples(
      "  asterflow mobility scenes/sphere_in_cell.toml\n"
      "  asterflow mobility scenes/sphere_in_cell.toml --set body.pnc.position=[19.5,0,0] > near_the_pole.json\n"));
  command->callback([options, &chosen] { chosen = [options] { print_mobility(*options); }; });
}

}  // namespace asterflow

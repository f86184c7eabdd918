#include "command/export.hpp"

#include "io/paraview.hpp"

#include <fmt/format.h>
#include <memory>

namespace asterflow {

namespace {

struct ExportOptions {
  std::string folder;
  std::string output;
};

void export_trajectory(ExportOptions const& options) {
  TrajectoryReader const trajectory(options.folder);
  trajectory.require_states();
  auto const& header = trajectory.header();
  Scene const scene = parse_scene(header.scene_text, header.scene_file, header.overrides);
  std::filesystem::path const output =
      options.output.empty() ? std::filesystem::path(options.folder) / "paraview" : std::filesystem::path(options.output);
  write_paraview(trajectory, scene, output);
  fmt::print("{}\n", (output / "asterflow.pvd").string());
}

}  // namespace

void add_export_command(CLI::App& program, Action& chosen) {
  auto const options = std::make_shared<ExportOptions>();
  auto* const command = program.add_subcommand(
      "export", "Write a trajectory for ParaView: fibers with tension, bodies and periphery over time.");
  command->add_option("folder", options->folder, "output folder of a run")->required();
  command->add_option("-o,--output", options->output, "folder for the files; DIR/paraview when not given");
  command->footer(examples(
      "  asterflow export out\n"
      "  paraview out/paraview/asterflow.pvd\n"
      "\nPlane fields for ParaView are written by asterflow flow.\n"));
  command->callback([options, &chosen] { chosen = [options] { export_trajectory(*options); }; });
}

}  // namespace asterflow

#include "command/run.hpp"

#include "command/simulate.hpp"
#include "io/scene.hpp"
#include "io/trajectory.hpp"
#include "io/versions.hpp"

#include <csignal>
#include <filesystem>
#include <fmt/format.h>
#include <memory>

namespace asterflow {

namespace {

struct RunOptions {
  std::string scene;
  std::string folder;
  std::vector<std::string> overrides;
};

void run(RunOptions const& options) {
  Scene const scene = read_scene(options.scene, options.overrides);
  std::filesystem::path folder = options.folder;
  if (folder.empty()) folder = std::filesystem::path(options.scene).stem().string() + "-results";
  int signal = 0;
  catch_signals();
  {
    auto trajectory = TrajectoryWriter::create(folder, {scene.text, std::filesystem::absolute(options.scene).string(),
                                                        scene.overrides, all_versions(), scene.run.seed});
    Simulation simulation(scene);
    store_state(simulation, trajectory);
    signal = simulate(simulation, trajectory, folder);
  }
  if (signal != 0) std::raise(signal);
  fmt::print("{}\n", (folder / "trajectory.h5").string());
  draw_last_state(scene, folder);
}

}  // namespace

void add_run_command(CLI::App& program, Action& chosen) {
  auto const options = std::make_shared<RunOptions>();
  auto* const command = program.add_subcommand("run", "Simulate a scene; write DIR/trajectory.h5 and show progress.");
  command->add_option("scene", options->scene, "scene file (TOML)")->required();
  command->add_option("-o,--output", options->folder, "new or empty folder; SCENE-results when not given");
  add_overrides(*command, options->overrides);
  command->footer(examples(
      "  asterflow run scenes/sphere.toml\n"
      "  asterflow run scenes/figure2.toml -o out --set run.end_time=30 --set body.pnc.force=[20,0,0]\n"
      "\nRead the result with Python:\n"
      "  import h5py\n"
      "  file = h5py.File('out/trajectory.h5')\n"
      "  x = file['frames/000010/body/position'][:]\n"
      "\nA run that was killed or interrupted goes on with: asterflow resume DIR\n"));
  command->callback([options, &chosen] { chosen = [options] { run(*options); }; });
}

}  // namespace asterflow

#include "command/resume.hpp"

#include "base/error.hpp"
#include "command/simulate.hpp"
#include "io/scene.hpp"
#include "io/trajectory.hpp"

#include <csignal>
#include <fmt/format.h>
#include <fstream>
#include <memory>
#include <sstream>

namespace asterflow {

namespace {

struct ResumeOptions {
  std::string folder;
  std::vector<std::string> overrides;
};

// The scene file may have gone; when it is there it must be the one that the run was started with.
void refuse_changed_scene(TrajectoryHeader const& header, std::string const& folder) {
  std::ifstream file(header.scene_file, std::ios::binary);
  if (!file) return;
  std::ostringstream text;
  text << file.rdbuf();
  if (text.str() != header.scene_text)
    throw SceneError(fmt::format("{}: has changed since the run in {} was started; restore or rename it to go on, or start "
                                 "a new run with -o", header.scene_file, folder));
}

bool moves_end(std::string const& one) { return one.starts_with("run.end_time="); }

// Only the end of the run may be moved: everything else would be another run.
void refuse_other_overrides(std::vector<std::string> const& overrides) {
  for (auto const& one : overrides)
    if (!moves_end(one))
      throw SceneError(fmt::format("--set {}: a resumed run can only change run.end_time; start a new run for anything "
                                   "else", one));
}

// To the last stored state.
void restore(Simulation& simulation, TrajectoryReader const& reader, std::string const& folder) {
  try {
    simulation.restore(reader.times().back(), reader.restart());
  } catch (SceneError const& error) {
    throw SceneError(folder + "/trajectory.h5: " + error.what());
  }
}

void resume(ResumeOptions const& options) {
  refuse_other_overrides(options.overrides);
  TrajectoryReader const reader(options.folder);
  auto const& header = reader.header();
  refuse_changed_scene(header, options.folder);
  auto overrides = header.overrides;
  if (!options.overrides.empty()) std::erase_if(overrides, moves_end);
  overrides.insert(overrides.end(), options.overrides.begin(), options.overrides.end());
  Scene const scene = parse_scene(header.scene_text, header.scene_file, overrides);

  bool const has_started = !reader.times().empty();
  double const time = has_started ? reader.times().back() : 0.0;
  if (has_started && time >= scene.run.end_time) {
    fmt::print(stderr, "the run in {} is complete (t = {:g} s); extend it with --set run.end_time=SECONDS\n",
               options.folder, time);
    return;
  }
  int signal = 0;
  catch_signals();
  {
    auto trajectory = TrajectoryWriter::resume(options.folder, overrides);
    Simulation simulation(scene);
    if (has_started) restore(simulation, reader, options.folder);
    else store_state(simulation, trajectory);
    signal = simulate(simulation, trajectory, options.folder);
  }
  if (signal != 0) std::raise(signal);
  fmt::print("{}/trajectory.h5\n", options.folder);
  draw_last_state(scene, options.folder);
}

}  // namespace

void add_resume_command(CLI::App& program, Action& chosen) {
  auto const options = std::make_shared<ResumeOptions>();
  auto* const command = program.add_subcommand(
      "resume", "Go on with an interrupted run: the result is that of a run that was never interrupted.");
  command->add_option("folder", options->folder, "output folder of the run")->required();
  command->add_option("--set", options->overrides, "only run.end_time=SECONDS, to extend a run")
      ->take_all()
      ->allow_extra_args(false);
  command->footer(examples(
      "  asterflow resume out\n"
      "  asterflow resume out --set run.end_time=600\n"));
  command->callback([options, &chosen] { chosen = [options] { resume(*options); }; });
}

}  // namespace asterflow

#include "command/observe.hpp"

#include "base/error.hpp"
#include "io/output_folder.hpp"
#include "io/picture.hpp"
#include "io/scene.hpp"
#include "io/trajectory.hpp"
#include "io/whole_file.hpp"
#include "observable/body_observables.hpp"
#include "observable/fiber_observables.hpp"
#include "observable/flow_observables.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <unistd.h>

namespace asterflow {

namespace fs = std::filesystem;

namespace {

struct ObserveOptions {
  std::string folder;
  std::string output;
  int every = 1;
  bool has_flow = true;
};

constexpr double bin_width = 1.0;  // um, of the distribution of lengths
constexpr int n_bin = 40;

std::string header_line(Observables const& row) {
  std::string line = "time";
  for (auto const& observable : row) line += "," + observable.name;
  return line;
}

std::string value_line(double time, Observables const& row) {
  std::string line = fmt::format("{:.9g}", time);
  for (auto const& observable : row) line += fmt::format(",{:.9g}", observable.value);
  return line;
}

std::string distribution_line(double time, StoredFibers const& fibers) {
  std::string line = fmt::format("{:.9g}", time);
  for (double const fraction : length_distribution(fibers, bin_width, n_bin)) line += fmt::format(",{:.6g}", fraction);
  return line;
}

std::string distribution_header() {
  std::string line = "time";
  for (int i = 0; i < n_bin; ++i) line += fmt::format(",from_{:g}", i * bin_width);
  return line;
}

void show_progress(std::size_t frame, std::size_t count) {
  if (isatty(STDERR_FILENO)) fmt::print(stderr, "\r\033[K{} of {} states", frame + 1, count);
}

// Rows for every chosen state.
void write_tables(ObserveOptions const& options, TrajectoryReader const& trajectory, std::ostream& table,
                  std::ostream& distribution) {
  auto const& header = trajectory.header();
  Scene const scene = parse_scene(header.scene_text, header.scene_file, header.overrides);
  SceneFlows const flows = options.has_flow ? make_flows(scene) : SceneFlows{};
  std::size_t const n = trajectory.times().size();
  for (std::size_t i = 0; i < n; i += options.every) {
    Frame const frame = trajectory.frame(i);
    StoredFibers const fibers = stored_fibers(scene, frame);
    Observables row = body_observables(scene, frame);
    auto const append = [&](Observables const& more) { row.insert(row.end(), more.begin(), more.end()); };
    append(fiber_observables(fibers));
    if (options.has_flow) append(flow_observables(scene, flows, frame, fibers));
    if (i == 0) table << header_line(row) << '\n', distribution << distribution_header() << '\n';
    table << value_line(frame.time, row) << '\n';
    distribution << distribution_line(frame.time, fibers) << '\n';
    show_progress(i, n);
  }
  if (isatty(STDERR_FILENO)) fmt::print(stderr, "\r\033[K");
}

void observe(ObserveOptions const& options) {
  TrajectoryReader const trajectory(options.folder);
  trajectory.require_states();
  fs::path const folder = options.output.empty() ? fs::path(options.folder) : fs::path(options.output);
  make_output_folder(folder);
  fs::path const numbers = folder / "observables.csv", lengths = folder / "lengths.csv", picture = folder / "observables.png";
  write_whole_text(numbers, [&](std::ostream& table) {
    write_whole_text(lengths, [&](std::ostream& distribution) { write_tables(options, trajectory, table, distribution); });
  });
  fmt::print("{}\n{}\n", numbers.string(), lengths.string());
  if (draw_picture("plot_observables.py", {numbers.string(), lengths.string(), picture.string()}))
    fmt::print("{}\n", picture.string());
}

}  // namespace

void add_observe_command(CLI::App& program, Action& chosen) {
  auto const options = std::make_shared<ObserveOptions>();
  auto* const command = program.add_subcommand(
      "observe", "What a trajectory shows, state by state: where bodies are and how they move, forces at the ends of the\n"
                 "fibers, their lengths, bending and tension, work, force and stresslet on the fluid, its speed.\n"
                 "Writes observables.csv, lengths.csv (distribution of lengths) and observables.png;\n"
                 "docs/observables.md says what the columns are.");
  command->add_option("folder", options->folder, "output folder of a run, finished or not")->required();
  command->add_option("-o,--output", options->output, "folder; that of the run when not given");
  command->add_option("--every", options->every, "only every n-th stored state")
      ->capture_default_str()->check(CLI::Range(1, 1000000));
  command->add_flag("!--no-flow", options->has_flow, "leave out what needs the flow: power, force on the fluid, speeds");
  command->footer(examples(
      "  asterflow observe out\n"
      "  asterflow observe out --every 10 --no-flow -o quick-look\n"));
  command->callback([options, &chosen] { chosen = [options] { observe(*options); }; });
}

}  // namespace asterflow

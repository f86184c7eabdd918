#include "command/flow.hpp"

#include "base/error.hpp"
#include "command/plane_flow.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <memory>

namespace asterflow {

namespace {

struct FlowOptions {
  std::string folder;
  double time = std::numeric_limits<double>::infinity();  // s
  std::string plane = "z=0";
  std::string grid = "240x150";
  std::vector<double> window;  // um: first lower, upper, second lower, upper
  std::string output;
};

void flow(FlowOptions const& options) {
  PlanePoints grid{parse_plane(options.plane), 0, 0, {}, {}};
  int n_first = 0, n_second = 0;
  parse_grid(options.grid, n_first, n_second);
  if (std::isnan(options.time)) throw SceneError("--time: must be a number (s)");
  TrajectoryReader const trajectory(options.folder);
  auto const& header = trajectory.header();
  Scene const scene = parse_scene(header.scene_text, header.scene_file, header.overrides);
  Frame const frame = trajectory.frame(trajectory.nearest(options.time));

  grid = surrounding(scene, frame, grid.plane);
  grid.n_first = n_first, grid.n_second = n_second;
  if (auto const& w = options.window; !w.empty()) {
    bool const is_finite = std::all_of(w.begin(), w.end(), [](double x) { return std::isfinite(x); });
    if (!(is_finite && w[0] < w[1] && w[2] < w[3])) throw SceneError("--window: must read LEFT RIGHT BOTTOM TOP with LEFT < RIGHT, BOTTOM < TOP (um)");
    grid.lower[0] = w[0], grid.upper[0] = w[1], grid.lower[1] = w[2], grid.upper[1] = w[3];
  }
  std::string const name = fmt::format("flow_t{:g}_{}{:g}", frame.time, "xyz"[grid.plane.normal], grid.plane.offset);
  std::filesystem::path const prefix =
      options.output.empty() ? std::filesystem::path(options.folder) / name : std::filesystem::path(options.output);
  for (auto const& path : write_plane_flow(plane_flow(scene, frame, grid), frame, prefix))
    fmt::print("{}\n", path.string());
}

}  // namespace

void add_flow_command(CLI::App& program, Action& chosen) {
  auto const options = std::make_shared<FlowOptions>();
  auto* const command = program.add_subcommand(
      "flow", "Velocity in a plane of a stored state: HDF5, a file for ParaView, and a picture with streamlines and\n"
              "fibers coloured by tension (red: compression, blue: extension).");
  command->add_option("folder", options->folder, "output folder of a run")->required();
  command->add_option("--time", options->time, "s; the stored state closest to it is taken, the last one when not given");
  command->add_option("--plane", options->plane, "x=VALUE, y=VALUE or z=VALUE (um)")->capture_default_str();
  command->add_option("--grid", options->grid, "points along the two axes of the plane")->capture_default_str();
  command->add_option("--window", options->window, "LEFT RIGHT BOTTOM TOP of the plane (um); all of the scene when not given")
      ->expected(4);
  command->add_option("-o,--output", options->output, "path without ending; DIR/flow_tTIME_PLANE when not given");
  command->footer(examples(
      "  asterflow flow out\n"
      "  asterflow flow out --time 30 --plane z=0 --grid 240x150\n"
      "  asterflow flow out --plane x=10 --window -15 15 -15 15 -o cross-section\n"));
  command->callback([options, &chosen] { chosen = [options] { flow(*options); }; });
}

}  // namespace asterflow

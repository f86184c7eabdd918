#include "command/drag.hpp"

#include "base/error.hpp"
#include "base/timer.hpp"
#include "command/progress.hpp"
#include "io/output_folder.hpp"
#include "io/picture.hpp"
#include "io/scene.hpp"
#include "io/whole_file.hpp"
#include "system/drag.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <memory>
#include <sstream>
#include <unistd.h>

namespace asterflow {

namespace fs = std::filesystem;

namespace {

struct DragOptions {
  std::string scene;
  std::string folder;
  std::vector<std::string> overrides;
};

// Writes all points so far; the file is replaced at once, so that an interrupted study leaves a whole one.
void write_points(fs::path const& path, std::vector<DragPoint> const& points) {
  write_whole_text(path, [&](std::ostream& file) {
    file << "level,fibers,translation_drag,translation_spread,rotation_drag,rotation_spread,"
            "gmres_iterations,rough_iterations,steps,seconds\n";
    for (auto const& p : points)
      file << fmt::format("{},{},{:.8g},{:.3g},{:.8g},{:.3g},{:.3g},{:.3g},{},{:.4g}\n", name_of(p.level), p.fiber_count,
                          p.translation, p.translation_spread, p.rotation, p.rotation_spread, p.iterations,
                          p.inner_iterations, p.steps, p.seconds);
  });
}

// What makes two studies one: the scene and its changes, but not which points are asked for.
std::string identity_of(Scene const& scene) {
  std::string text;
  for (auto const& change : scene.overrides)
    if (!change.starts_with("drag.fiber_counts=") && !change.starts_with("drag.levels=")) text += "# --set " + change + "\n";
  return text + scene.text;
}

std::string read_text(fs::path const& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// The points of an earlier, perhaps interrupted study of the same scene.
std::vector<DragPoint> read_points(fs::path const& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  std::vector<DragPoint> points;
  while (std::getline(file, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    std::string level;
    DragPoint p;
    words >> level >> p.fiber_count >> p.translation >> p.translation_spread >> p.rotation >> p.rotation_spread >>
        p.iterations >> p.inner_iterations >> p.steps >> p.seconds;
    bool is_known = false;
    for (auto const candidate : {Interactions::local, Interactions::open, Interactions::confined})
      if (level == name_of(candidate)) p.level = candidate, is_known = true;
    if (!words || !is_known) throw SceneError(path.string() + ": is not a table of this study; choose another folder with -o");
    points.push_back(p);
  }
  return points;
}

fs::path prepare_folder(DragOptions const& options, Scene const& scene) {
  fs::path folder = options.folder;
  if (folder.empty()) folder = fs::path(options.scene).stem().string() + "-drag";
  std::error_code error;
  if (fs::exists(folder / "drag.csv", error) && read_text(folder / "drag.toml") != identity_of(scene))
    throw SceneError((folder / "drag.csv").string() + ": is there already, of another scene; choose another folder with -o");
  make_output_folder(folder);
  if (read_text(folder / "drag.toml") != identity_of(scene))
    write_whole_text(folder / "drag.toml", [&](std::ostream& file) { file << identity_of(scene); });
  return folder;
}

void show(DragPoint const& point, double fraction, Timer const& timer) {
  if (!isatty(STDERR_FILENO)) return;
  fmt::print(stderr, "\r\033[K{} with {} fibers: {:.0f} %   {} so far", name_of(point.level), point.fiber_count,
             100 * fraction, duration_words(timer.seconds()));
}

void study(DragOptions const& options) {
  Scene const scene = read_scene(options.scene, options.overrides);
  for (Interactions level : scene.drag.levels)
    if (level == Interactions::confined && !scene.periphery)
      throw SceneError(options.scene + ": [drag]: levels: confined needs a [periphery]");
  fs::path const folder = prepare_folder(options, scene);
  fs::path const table = folder / "drag.csv", picture = folder / "drag.png";
  std::vector<DragPoint> points = read_points(table);
  auto const is_known = [&](Interactions level, int fiber_count) {
    return std::any_of(points.begin(), points.end(),
                       [&](DragPoint const& p) { return p.level == level && p.fiber_count == fiber_count; });
  };
  Timer const timer;
  auto const done = [&](DragPoint const& point) {
    points.push_back(point);
    write_points(table, points);
    fmt::print(stderr, "{}{:<9} {:>5} fibers   translation {:8.4g}   rotation {:8.4g}   {:.1f} + {:.1f} iterations   {}\n",
               isatty(STDERR_FILENO) ? "\r\033[K" : "", name_of(point.level), point.fiber_count, point.translation,
               point.rotation, point.iterations, point.inner_iterations, duration_words(point.seconds));
  };
  drag_study(scene, is_known, done, [&](DragPoint const& point, double fraction) { show(point, fraction, timer); });
  fmt::print("{}\n", table.string());
  if (draw_picture("plot_drag.py", {table.string(), picture.string()})) fmt::print("{}\n", picture.string());
}

}  // namespace

void add_drag_command(CLI::App& program, Action& chosen) {
  auto const options = std::make_shared<DragOptions>();
  auto* const command = program.add_subcommand(
      "drag", "The paper's Figure 2: drag of a body with growing fibers against their number, for the levels local, open\n"
              "and confined, relative to the body alone in unbounded fluid. Writes DIR/drag.csv and DIR/drag.png; the\n"
              "table [drag] of the scene says which numbers, levels, force, torque and times. Points that drag.csv has\n"
              "already, from an interrupted study of the same scene, are kept.");
  command->add_option("scene", options->scene, "scene file (TOML)")->required();
  command->add_option("-o,--output", options->folder, "folder; SCENE-drag when not given");
  add_overrides(*command, options->overrides);
  command->footer(examples(
      "  asterflow drag scenes/figure2.toml -o figure2\n"
      "  asterflow drag scenes/figure2.toml -o quick --set drag.fiber_counts=[0,100,200] --set drag.duration=1\n"));
  command->callback([options, &chosen] { chosen = [options] { study(*options); }; });
}

}  // namespace asterflow

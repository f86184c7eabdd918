#include "command/torque.hpp"

#include "base/error.hpp"
#include "io/output_folder.hpp"
#include "io/picture.hpp"
#include "io/whole_file.hpp"
#include "system/torque_instability.hpp"

#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <memory>

namespace asterflow {

namespace fs = std::filesystem;

namespace {

struct TorqueOptions {
  std::string scene;
  std::string folder;
  int n_angle = 73;
  std::vector<std::string> overrides;
};

void write_curve(fs::path const& path, std::vector<TorquePoint> const& points) {
  write_whole_text(path, [&](std::ostream& file) {
    file << "angle_degrees,free_sliding,no_sliding,free_sliding_of_fibers,no_sliding_of_fibers\n";
    for (auto const& p : points)
      file << fmt::format("{:.8g},{:.12g},{:.12g},{:.12g},{:.12g}\n", p.angle, p.continuum.free_sliding,
                          p.continuum.no_sliding, p.fibers.free_sliding, p.fibers.no_sliding);
  });
}

fs::path prepare_folder(TorqueOptions const& options) {
  fs::path folder = options.folder;
  if (folder.empty()) folder = fs::path(options.scene).stem().string() + "-torque";
  std::error_code error;
  if (fs::exists(folder / "torque.csv", error))
    throw SceneError((folder / "torque.csv").string() + ": is there already; choose another folder with -o");
  make_output_folder(folder);
  return folder;
}

// d(Omega / Omega_0) / d alpha, per radian, at an angle: positive where a small turn grows.
TurningRates growth_at(Scene const& scene, double angle) {
  constexpr double step = 0.5;  // degrees
  auto const sides = torque_instability(scene, {angle - step, angle + step});
  double const scale = 180.0 / M_PI / (2.0 * step);
  return {scale * (sides[1].continuum.free_sliding - sides[0].continuum.free_sliding),
          scale * (sides[1].continuum.no_sliding - sides[0].continuum.no_sliding)};
}

std::string_view stability(double growth) {
  if (std::abs(growth) < 1e-9) return "neutral";  // nothing turns the body, as in a sphere
  return growth > 0.0 ? "unstable" : "stable";
}

void draw_curve(TorqueOptions const& options) {
  Scene const scene = read_scene(options.scene, options.overrides);
  std::vector<double> angles;
  for (int i = 0; i < options.n_angle; ++i) angles.push_back(-90.0 + 180.0 * i / (options.n_angle - 1));
  auto const points = torque_instability(scene, angles);
  fs::path const folder = prepare_folder(options);
  fs::path const table = folder / "torque.csv", picture = folder / "torque.png";
  write_curve(table, points);
  for (double const angle : {-90.0, 0.0, 90.0}) {
    auto const growth = growth_at(scene, angle);
    fmt::print("{:>4g} degrees: growth {:+.5g} free sliding, {:+.5g} no sliding: {}\n", angle, growth.free_sliding,
               growth.no_sliding, stability(growth.no_sliding));
  }
  fmt::print("{}\n", table.string());
  if (draw_picture("plot_torque.py", {table.string(), picture.string()})) fmt::print("{}\n", picture.string());
}

}  // namespace

void add_torque_command(CLI::App& program, Action& chosen) {
  auto const options = std::make_shared<TorqueOptions>();
  auto* const command = program.add_subcommand(
      "torque", "The paper's Figure 10: the angular velocity of a body that straight fibers push off the periphery, against\n"
                "the angle between its first aster's axis and the x axis (turned about z), for a push along the cortex\n"
                "normal (free sliding) and along the fiber (no sliding). Writes DIR/torque.csv and DIR/torque.png, and\n"
                "prints whether the angles -90, 0 and 90 degrees are stable.");
  command->add_option("scene", options->scene, "scene file (TOML) with a [periphery], a [[body]] and its [[aster]]s")
      ->required();
  command->add_option("-o,--output", options->folder, "folder; SCENE-torque when not given");
  command->add_option("--angles", options->n_angle, "number of angles from -90 to 90 degrees")
      ->capture_default_str()->check(CLI::Range(2, 100000));
  add_overrides(*command, options->overrides);
  command->footer(examples(
      "  asterflow torque scenes/torque_instability.toml -o torque\n"
      "  asterflow torque scenes/torque_instability.toml -o flat --set periphery.semi_axes=[25,15,10]\n"));
  command->callback([options, &chosen] { chosen = [options] { draw_curve(*options); }; });
}

}  // namespace asterflow

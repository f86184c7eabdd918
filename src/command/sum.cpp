#include "command/sum.hpp"

#include "backends/evaluator.hpp"
#include "base/error.hpp"
#include "base/random.hpp"
#include "base/timer.hpp"
#include "command/json.hpp"
#include "io/points_file.hpp"
#include "kernels/list.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <numeric>
#include <optional>

namespace asterflow {

namespace {

struct SumOptions {
  std::string kernel = "stokeslet";
  std::string input;
  std::string output;
  std::string backend = "auto";
  double accuracy = 1e-6;
  double viscosity = 1.0;
  bool has_gradient = false, has_pressure = false;
  bool measures_error = false;
  int repeat = 1;
};

// Normals become unit vectors; the stresslet is linear in them, so their length moves into the strength.
void absorb_normal_lengths(PointsFile& points) {
  for (std::size_t i = 0; i < points.normals.size(); ++i) {
    Vec3d const n = points.normals[i];
    double const length = std::hypot(n.x, n.y, n.z);  // also of components whose squares overflow
    points.strengths[i] *= length;
    points.normals[i] = length > 0.0 ? n / length : Vec3d{1.0, 0.0, 0.0};
  }
}

// Relative L2 error against the reference backend, on at most 2000 targets drawn at random.
double error_against_reference(SumOptions const& options, PointsFile const& points, ConstPoints velocity) {
  std::vector<std::size_t> chosen(points.targets.size());
  std::iota(chosen.begin(), chosen.end(), std::size_t{0});
  std::size_t const n_chosen = std::min<std::size_t>(chosen.size(), 2000);
  for (std::size_t i = 0; i < n_chosen; ++i)
    std::swap(chosen[i], chosen[i + std::size_t(uniform_random(1, 0, i, 0) * double(chosen.size() - i))]);
  PointArray targets(n_chosen), exact(n_chosen);
  for (std::size_t i = 0; i < n_chosen; ++i) targets[i] = points.targets[chosen[i]];

  auto const reference = make_evaluator(options.kernel, {"reference", 1e-15});
  reference->set_points(points.sources, targets, points.normals);
  reference->add_velocity(points.strengths, exact);
  double largest = 0.0;  // of the exact components: squares of velocities in this unit neither over- nor underflow
  for (Vec3d const& u : exact) largest = std::max({largest, std::abs(u.x), std::abs(u.y), std::abs(u.z)});
  double const unit = largest > 0.0 ? largest : 1.0;
  double difference2 = 0.0, exact2 = 0.0;
  for (std::size_t i = 0; i < n_chosen; ++i) {
    Vec3d const difference = (velocity[chosen[i]] - exact[i]) / unit, u = exact[i] / unit;
    difference2 += dot(difference, difference);
    exact2 += dot(u, u);
  }
  return exact2 > 0.0 ? std::sqrt(difference2 / exact2) : std::sqrt(difference2);
}

void check_output(SumOptions const& options) {
  std::error_code ignored;
  if (std::filesystem::equivalent(options.input, options.output, ignored))
    throw SceneError(options.output + ": is the input file; choose another --output");
  if (std::filesystem::is_directory(options.output, ignored))
    throw SceneError(options.output + ": is a folder; --output must be a file");
  if (std::filesystem::exists(options.output, ignored) && !std::filesystem::is_regular_file(options.output, ignored))
    throw SceneError(options.output + ": is a device, which a file would replace; choose another --output");
  auto const folder = std::filesystem::path(options.output).parent_path();
  if (!folder.empty() && !std::filesystem::is_directory(folder, ignored))
    throw SceneError(options.output + ": the folder " + folder.string() + " does not exist");
}

// The pressure at the targets, Pa for strengths in pN and lengths in um. A rotlet has none.
std::vector<double> pressure_of(SumOptions const& options, PointsFile const& points) {
  std::vector<double> pressure(points.targets.size());
  if (options.kernel == "rotlet") return pressure;
  auto const evaluator = make_evaluator(options.kernel + "_pressure", {options.backend, options.accuracy});
  evaluator->set_points(points.sources, points.targets, points.normals);
  PointArray flow(points.targets.size());  // (p, 0, 0)
  evaluator->add_velocity(points.strengths, flow);
  double const unit = options.kernel == "stresslet" ? options.viscosity : 1.0;  // a force's does not depend on it
  for (std::size_t i = 0; i < flow.size(); ++i) pressure[i] = unit * flow[i].x;
  return pressure;
}

void sum(SumOptions const& options) {
  if (!(options.viscosity > 0.0 && std::isnormal(options.viscosity)))
    throw SceneError(fmt::format("viscosity: {} must be positive and finite", options.viscosity));
  bool needs_normals = false;
  if (!with_kernel<AllKernels>(options.kernel, [&](auto kernel) { needs_normals = kernel.has_normal; }))
    throw SceneError("kernel: unknown \"" + options.kernel + "\" (known: " + kernel_names() + ")");
  auto const evaluator = make_evaluator(options.kernel, {options.backend, options.accuracy, options.has_gradient});
  check_output(options);
  PointsFile points = read_points_file(options.input, needs_normals);
  absorb_normal_lengths(points);

  Timer timer;
  evaluator->set_points(points.sources, points.targets, points.normals);
  double const seconds_setup = timer.seconds();
  PointArray velocity;
  double seconds = std::numeric_limits<double>::infinity();
  for (int i = 0; i < options.repeat; ++i) {
    velocity.assign(points.targets.size(), {});
    timer.restart();
    evaluator->add_velocity(points.strengths, velocity);
    seconds = std::min(seconds, timer.seconds());
  }
  std::optional<double> error;
  if (options.measures_error) error = error_against_reference(options, points, velocity);
  PointArray gradient(options.has_gradient ? 3 * points.targets.size() : 0);
  if (options.has_gradient) evaluator->add_gradient(points.strengths, gradient);
  if (!needs_normals)  // a double layer's density is a velocity and carries no viscosity
    for (PointArray* flow : {&velocity, &gradient})
      for (Vec3d& u : *flow) u *= 1.0 / options.viscosity;
  write_sums(options.output, velocity, gradient, options.has_pressure ? pressure_of(options, points) : std::vector<double>{});

  double const pairs = double(points.sources.size()) * double(points.targets.size());
  fmt::print(
      "{{\"kernel\": \"{}\", \"n\": {}, \"m\": {}, \"accuracy\": {:g}, \"backend\": \"{}\", \"setup_seconds\": {:.6g}, "
      "\"execute_seconds\": {:.6g}, \"pairs_per_second\": {:.4g}, \"error\": {}, \"output\": {}}}\n",
      options.kernel, points.sources.size(), points.targets.size(), options.accuracy, evaluator->backend(),
      seconds_setup, seconds, seconds > 0.0 ? pairs / seconds : 0.0, error ? fmt::format("{:.3g}", *error) : "null",
      json_text(options.output));
}

}  // namespace

void add_sum_command(CLI::App& program, Action& chosen) {
  auto const options = std::make_shared<SumOptions>();
  auto* const command = program.add_subcommand(
      "sum",
      "Pair sums over your own points: velocity at every target from all sources.\n"
      "  stokeslet  u = (1/(8 pi mu)) (1/r + r r/r^3) f     strengths f: forces on the fluid\n"
      "  rotlet     u = (1/(8 pi mu)) L x r/r^3             strengths L: torques on the fluid\n"
      "  stresslet  u = -(3/(4 pi)) r (r.q)(r.n)/r^5        strengths q: densities, normals n (no viscosity)\n"
      "with r = target - source; a source contributes nothing at r = 0.");
  command->add_option("--kernel", options->kernel, "stokeslet, stresslet or rotlet")->capture_default_str();
  command
      ->add_option("-i,--input", options->input,
                   "HDF5 file with sources [n,3], strengths [n,3], targets [m,3] (the sources when absent) and, for the "
                   "stresslet, normals [n,3]")
      ->required();
  command->add_option("-o,--output", options->output, "HDF5 file for velocity [m,3]; replaced when present")->required();
  command->add_option("--backend", options->backend, fmt::format("one of {}", fmt::join(backend_names(), ", ")))
      ->capture_default_str();
  command->add_option("--accuracy", options->accuracy, "relative L2 error asked for, 1e-15 to 1e-1")
      ->capture_default_str();
  command->add_option("--viscosity", options->viscosity, "mu, positive")->capture_default_str();
  command->add_flag("--gradient", options->has_gradient, "write d velocity_i / d x_j at the targets too: gradient [m,3,3]");
  command->add_flag("--pressure", options->has_pressure,
                    "write the pressure at the targets too: pressure [m]; one more sum, to the same accuracy\n"
                    "  stokeslet  p = r.f/(4 pi r^3)      rotlet  p = 0\n"
                    "  stresslet  p = -(mu/(2 pi)) (3 (r.q)(r.n)/r^5 - q.n/r^3)");
  command->add_flag("--reference-error", options->measures_error,
                    "measure the error against plain loops, on at most 2000 targets");
  command->add_option("--repeat", options->repeat, "evaluate so often and report the fastest")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command->footer(examples(
      "  asterflow sum --kernel stokeslet --input points.h5 --accuracy 1e-6 --backend auto --output u.h5\n"
      "  asterflow sum --kernel stresslet --input points.h5 --reference-error --repeat 5 --output u.h5\n"
      "\nMake points.h5 with Python:\n"
      "  import h5py, numpy\n"
      "  with h5py.File('points.h5', 'w') as f:\n"
      "      for name in ('sources', 'strengths', 'normals'): f[name] = numpy.random.randn(20000, 3)\n"));
  command->callback([options, &chosen] { chosen = [options] { sum(*options); }; });
}

}  // namespace asterflow

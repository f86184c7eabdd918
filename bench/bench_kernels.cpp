// Speed and achieved error of direct pair sums, against the fused multiply-add peak measured in the same run.
// JSON on standard output.
//
// The bound counts the multiplications and fused multiply-adds of one pair and its hardware estimate of 1 / |r|, all of
// which need the same units; additions and subtractions, loads and masks are left out. Rates are per CPU second
// (both threads of a sum count), so that they mean the same on a busy machine; wall time is given besides.

#include "backends/backend.hpp"
#include "base/cpu_time.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"
#include "base/timer.hpp"
#include "fma_peak.hpp"
#include "kernels/list.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

using namespace asterflow;

namespace {

struct Options {
  std::size_t points = 20000;
  int repeats = 7;
  bool dry_run = false;
};

struct Problem {
  PointArray sources, targets, strengths, normals;
};

PointArray random_points(std::size_t n, std::uint64_t seed) {
  PointArray points(n);
  for (std::size_t i = 0; i < n; ++i)
    for (int c = 0; c < 3; ++c) points[i][c] = 2.0 * uniform_random(seed, i, 0, c) - 1.0;
  return points;
}

Problem make_problem(std::size_t n, bool is_self, bool has_normal) {
  Problem p{random_points(n, 1), random_points(n, 2), random_points(n, 3), {}};
  if (is_self) p.targets = p.sources;
  if (has_normal) p.normals = random_points(n, 4);
  for (auto& normal : p.normals) normal = normalized(normal);
  return p;
}

// Multiplications and fused multiply-adds of one pair: |r|^2, estimate, correction, powers of 1 / |r|, and what depends
// on the strength. A sum both ways does all but the last once for two pairs.
double instructions_per_pair(std::string_view kernel, int steps, bool is_both_ways) {
  int const distance = 3 + 1 + (steps > 0 ? 3 + steps : 0);
  int const powers = kernel == "stokeslet" ? 1 : kernel == "stresslet" ? 3 : 2;
  int const strength = kernel == "stokeslet" ? 10 : kernel == "stresslet" ? 11 : 9;
  return is_both_ways ? 0.5 * (distance + powers) + strength : distance + powers + strength;
}

double achieved_error(Problem const& p, std::string_view kernel, PointArray const& velocity) {
  std::size_t const stride = std::max<std::size_t>(1, velocity.size() / 2000);
  PointArray targets, exact;
  for (std::size_t i = 0; i < velocity.size(); i += stride) targets.push_back(p.targets[i]);
  exact.resize(targets.size());
  auto const reference = make_evaluator(kernel, {.backend = "reference"});
  reference->set_points(p.sources, targets, p.normals);
  reference->add_velocity(p.strengths, exact);
  double error = 0.0, norm2 = 0.0;
  for (std::size_t k = 0; k < exact.size(); ++k) {
    Vec3d const e = velocity[k * stride] - exact[k];
    error += dot(e, e);
    norm2 += dot(exact[k], exact[k]);
  }
  return std::sqrt(error / norm2);
}

struct Rate {
  double set_seconds = 1e300, cpu_seconds = 1e300, wall_seconds = 1e300;
};

Rate measure(Evaluator& evaluator, Problem const& p, int repeats, PointArray& velocity) {
  Rate best;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    Timer const set;
    evaluator.set_points(p.sources, p.targets, p.normals);
    best.set_seconds = std::min(best.set_seconds, set.seconds());
    std::fill(velocity.begin(), velocity.end(), Vec3d{});
    double const start = cpu_seconds();
    Timer const wall;
    evaluator.add_velocity(p.strengths, velocity);
    best.wall_seconds = std::min(best.wall_seconds, wall.seconds());
    best.cpu_seconds = std::min(best.cpu_seconds, cpu_seconds() - start);
  }
  return best;
}

std::string machine() {
  std::ifstream cpus("/proc/cpuinfo");
  for (std::string line; std::getline(cpus, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown";
}

// One line of JSON.
std::string record(std::string_view instructions, std::string_view kernel, double accuracy, bool is_self,
                   Options const& options) {
  auto const [bits, steps, lanes, error] = pair_arithmetic(instructions, kernel, accuracy);
  Problem const p = make_problem(options.points, is_self, kernel == "stresslet");
  auto const evaluator = make_evaluator(kernel, {"direct-" + std::string(instructions), accuracy});
  PointArray velocity(options.points);
  Rate const rate = measure(*evaluator, p, options.repeats, velocity);
  double const pairs = static_cast<double>(p.sources.size()) * static_cast<double>(p.targets.size());
  double const peak = fma_per_second(instructions, bits);
  double const bound = peak * lanes / instructions_per_pair(kernel, steps, is_self);
  return fmt::format(
      "{{\"kernel\": \"{}\", \"instructions\": \"{}\", \"self_sum\": {}, \"accuracy\": {:.0e}, \"achieved\": {:.2e}, "
      "\"arithmetic\": \"{}\", \"correction_steps\": {}, \"set_points_seconds\": {:.3g}, \"wall_seconds\": {:.4g}, "
      "\"Gpairs_per_cpu_second\": {:.3f}, \"bound_Gpairs_per_cpu_second\": {:.3f}, \"fraction_of_bound\": {:.3f}, "
      "\"Gfma_per_cpu_second\": {:.3f}}}",
      kernel, instructions, is_self, accuracy, achieved_error(p, kernel, velocity), bits == 64 ? "double" : "float", steps,
      rate.set_seconds, rate.wall_seconds, 1e-9 * pairs / rate.cpu_seconds, 1e-9 * bound,
      pairs / rate.cpu_seconds / bound, 1e-9 * peak);
}

void run(Options const& options) {
  fmt::print("{{\"machine\": \"{}\", \"commit\": \"{}\", \"threads\": {}, \"points\": {}, \"sums\": [", machine(),
             ASTERFLOW_COMMIT, thread_count(), options.points);
  char const* separator = "\n  ";
  auto const names = backend_names();
  for (std::string_view const instructions : {"avx512", "avx2"}) {
    if (std::find(names.begin(), names.end(), "direct-" + std::string(instructions)) == names.end()) continue;
    std::apply(
        [&](auto... kernel) {
          for (std::string_view const name : {kernel.name...})
            for (double const accuracy : {1e-3, 1e-6, 1e-9, 1e-12, 1e-15})
              for (bool const is_self : {true, false}) {
                fmt::print("{}{}", separator, record(instructions, name, accuracy, is_self, options));
                std::fflush(stdout);
                separator = ",\n  ";
              }
        },
        AllKernels{});
  }
  fmt::print("\n]}}\n");
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Speed and achieved error of direct pair sums, as JSON");
  app.add_option("--points", options.points, "sources and targets")->check(CLI::Range(1, 10000000));
  app.add_option("--repeats", options.repeats, "the best of so many is printed")->check(CLI::Range(1, 1000));
  app.add_flag("--dry-run", options.dry_run, "few points, once: does the program work?");
  CLI11_PARSE(app, argc, argv);
  if (options.dry_run) options = {600, 1, true};
  ParallelScope const threads;
  run(options);
  return 0;
}

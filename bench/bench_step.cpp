// Time of implicit steps of a scene: seconds per step and what they go to, GMRES iterations, memory; means over the second
// half of the steps. JSON on standard output.
//   bench_step SCENE.toml [STEPS] [table.key=value ...]

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/timer.hpp"
#include "system/simulation.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <cstdio>
#include <cstdlib>

using namespace asterflow;

namespace {

double peak_memory() {  // MB
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

// Of steps in the same units as a step.
void print_mean(std::vector<StepReport> const& steps) {
  double iterations = 0.0, inner = 0.0, seconds = 0.0, sums = 0.0;
  for (StepReport const& r : steps) {
    iterations += r.iterations;
    inner += r.inner_iterations;
    seconds += r.seconds;
    sums += r.sum_seconds + r.rough_sum_seconds;
  }
  auto const n = static_cast<double>(steps.size());
  fmt::print(" \"mean\": {{\"iterations\": {:.3g}, \"inner_iterations\": {:.3g}, \"seconds\": {:.4g}, \"seconds_over_sums\": {}}},\n",
             iterations / n, inner / n, seconds / n, sums > 0 ? fmt::format("{:.3g}", seconds / sums) : "null");
}

void run(std::string const& file, int n_step, std::vector<std::string> const& overrides) {
  Timer const set_up;
  Simulation simulation(read_scene(file, overrides));
  fmt::print("{{\"scene\": \"{}\", \"fibers\": {}, \"nodes\": {}, \"set_up_seconds\": {:.4g}, \"steps\": [", file,
             simulation.fibers().count(), simulation.fibers().node_count(), set_up.seconds());
  std::vector<StepReport> later;
  for (int i = 0; i < n_step; ++i) {
    StepReport const r = simulation.step(1e9);
    if (2 * i >= n_step) later.push_back(r);
    fmt::print("{}\n  {{\"time\": {:.6g}, \"dt\": {:.4g}, \"iterations\": {}, \"inner_iterations\": {}, \"residual\": {:.3g}, "
               "\"rejected\": {}, \"error_um\": {:.3g}, \"seconds\": {:.4g}, \"seconds_prepare\": {:.4g}, "
               "\"seconds_sums\": {:.4g}, \"seconds_surfaces\": {:.4g}, \"seconds_rough_sums\": {:.4g}, \"seconds_rough_surfaces\": {:.4g}}}",
               i == 0 ? "" : ",", r.time, r.dt, r.iterations, r.inner_iterations, r.residual, r.rejected, r.error,
               r.seconds, r.prepare_seconds, r.sum_seconds, r.surface_seconds, r.rough_sum_seconds,
               r.rough_surface_seconds);
    std::fflush(stdout);
  }
  fmt::print("],\n");
  print_mean(later);
  fmt::print(" \"threads\": {}, \"peak_memory_MB\": {:.0f}}}\n", thread_count(), peak_memory());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: bench_step SCENE.toml [STEPS] [table.key=value ...]\n");
    return 1;
  }
  ParallelScope const threads;
  try {
    run(argv[1], argc > 2 ? std::atoi(argv[2]) : 5, {argv + std::min(argc, 3), argv + argc});
  } catch (std::exception const& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}

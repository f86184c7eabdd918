// Time and error of pair sums by every backend asked for. One JSON record per line on standard output:
// set-up and execute seconds (wall of the best of the repetitions and CPU over all threads in it, every set-up with an evaluator of its own;
// the first set-up, which also pays for new memory, apart), relative L2 error on up to 2000 random targets against the
// reference, bytes held.

#include "bench/point_sets.hpp"

#include "backends/evaluator.hpp"
#include "base/cpu_time.hpp"
#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"
#include "base/timer.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

using namespace asterflow;

namespace {

struct Choice {
  std::vector<std::string> backends{"fast"}, kernels{"stokeslet"}, distributions{"uniform"};
  std::vector<double> accuracies{1e-3, 1e-6, 1e-9}, counts{1e4, 1e5};
  int repetitions = 3;
  bool dry_run = false;
};

struct Problem {
  PointArray points, strengths, normals;
  std::vector<std::size_t> chosen;  // targets at which the error is measured
  PointArray exact;                 // velocity there
};

Problem make_problem(std::string const& kernel, std::string const& distribution, long n) {
  Problem problem{bench::points(distribution, n), bench::strengths(n),
                  kernel.starts_with("stresslet") ? bench::normals(n) : PointArray{}, {}, {}};
  PointArray targets;
  long const n_target = std::min(n, 2000L);
  for (long k = 0; k < n_target; ++k) {
    problem.chosen.push_back(static_cast<std::size_t>(
        n <= n_target ? static_cast<double>(k) : uniform_random(11, k, 0, 0) * static_cast<double>(n)));
    targets.push_back(problem.points[problem.chosen.back()]);
  }
  problem.exact.resize(targets.size());
  auto const reference = make_evaluator(kernel, {"reference", 1e-15});
  reference->set_points(problem.points, targets, problem.normals);
  reference->add_velocity(problem.strengths, problem.exact);
  return problem;
}

double achieved_error(Problem const& problem, PointArray const& velocity) {
  double error = 0.0, size = 0.0;
  for (std::size_t k = 0; k < problem.chosen.size(); ++k) {
    Vec3d const difference = velocity[problem.chosen[k]] - problem.exact[k];
    error += dot(difference, difference);
    size += dot(problem.exact[k], problem.exact[k]);
  }
  return std::sqrt(error / size);
}

void measure(Choice const& choice, std::string const& backend, std::string const& kernel, std::string const& distribution,
             double accuracy, Problem const& problem) {
  std::unique_ptr<Evaluator> evaluator;
  PointArray velocity(problem.points.size());
  double first_set_up = 0.0, set_up = 1e300, set_up_cpu = 1e300, wall = 1e300, cpu = 1e300;
  Timer timer;
  for (int i = 0; i < choice.repetitions; ++i) {
    evaluator = make_evaluator(kernel, {backend, accuracy});
    double const before = cpu_seconds();
    timer.restart();
    evaluator->set_points(problem.points, problem.points, problem.normals);
    if (double const seconds = timer.seconds(); seconds < set_up) {
      set_up = seconds;
      set_up_cpu = cpu_seconds() - before;
    }
    if (i == 0) first_set_up = set_up;
  }
  for (int i = 0; i < choice.repetitions; ++i) {
    std::fill(velocity.begin(), velocity.end(), Vec3d{});
    double const before = cpu_seconds();
    timer.restart();
    evaluator->add_velocity(problem.strengths, velocity);
    if (double const seconds = timer.seconds(); seconds < wall) {
      wall = seconds;
      cpu = cpu_seconds() - before;
    }
  }
  fmt::print("{{\"backend\": \"{}\", \"used\": \"{}\", \"kernel\": \"{}\", \"distribution\": \"{}\", \"n\": {}, "
             "\"accuracy\": {:.1e}, \"error\": {:.2e}, \"first_set_up_seconds\": {:.4g}, \"set_up_seconds\": {:.4g}, \"set_up_cpu_seconds\": {:.4g}, "
             "\"execute_seconds\": {:.4g}, \"execute_cpu_seconds\": {:.4g}, \"bytes\": {}, \"threads\": {}, \"commit\": \"{}\"}}\n",
             backend, evaluator->backend(), kernel, distribution, problem.points.size(), accuracy,
             achieved_error(problem, velocity), first_set_up, set_up, set_up_cpu, wall, cpu, evaluator->memory(), thread_count(), ASTERFLOW_COMMIT);
  std::fflush(stdout);
}

void run(Choice const& choice) {
  for (auto const& kernel : choice.kernels)
    for (auto const& distribution : choice.distributions)
      for (double n : choice.counts) {
        Problem const problem = make_problem(kernel, distribution, static_cast<long>(n));
        for (double accuracy : choice.accuracies)
          for (auto const& backend : choice.backends) measure(choice, backend, kernel, distribution, accuracy, problem);
      }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Time and error of pair sums");
  Choice choice;
  app.add_option("--backend", choice.backends, "backends, see asterflow sum --help");
  app.add_option("--kernel", choice.kernels, "stokeslet, stresslet, rotlet");
  app.add_option("--distribution", choice.distributions, "uniform, sphere, aster, line, clusters");
  app.add_option("--accuracy", choice.accuracies, "relative errors asked for");
  app.add_option("-n,--count", choice.counts, "numbers of points");
  app.add_option("--repetitions", choice.repetitions, "sums of which the best counts");
  app.add_flag("--dry-run", choice.dry_run, "every kernel and distribution once with few points");
  CLI11_PARSE(app, argc, argv);
  if (choice.dry_run) {
    choice = {{"fast", "auto"}, {"stokeslet", "stresslet", "rotlet"}, bench::distributions(), {1e-3}, {600}, 1, true};
  }
  ParallelScope const threads;
  try {
    run(choice);
  } catch (std::exception const& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}

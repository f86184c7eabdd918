#include "command/simulate.hpp"

#include "base/error.hpp"
#include "command/plane_flow.hpp"
#include "command/progress.hpp"
#include "system/no_slip.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <csignal>
#include <fmt/format.h>
#include <optional>

namespace asterflow {

namespace {

std::atomic<int> caught_signal = 0;

// The first signal asks the run to stop after its step; a second one ends the program at once.
void note_signal(int signal) {
  caught_signal = signal;
  std::signal(signal, SIG_DFL);
}

// The next time to store a state: a multiple of the interval, so that a resumed run takes the same steps.
double next_output(double time, double interval, double end_time) {
  double const n = std::floor(time / interval * (1.0 + 1e-12) + 1e-9) + 1.0;
  return std::min(n * interval, end_time);
}

// Not before the first step, nor in a `local` scene.
bool has_flow(Scene const& scene, double time) { return scene.run.interactions != Interactions::local && time > 0.0; }

// None without flow or surfaces.
std::optional<NoSlipResidual> no_slip_of(Simulation const& simulation, Frame const& frame) {
  if (!has_flow(simulation.scene(), frame.time) || (simulation.flows().bodies.empty() && !simulation.flows().periphery)) return std::nullopt;
  return no_slip_residual(StoredFlow(simulation.scene(), simulation.flows(), frame));
}

// A state without flow still has its objects.
std::string way_to_look(Simulation const& simulation, std::filesystem::path const& folder) {
  if (!has_flow(simulation.scene(), simulation.time())) return fmt::format("asterflow export {}", folder.string());
  return fmt::format("asterflow flow {} --time {:g}", folder.string(), simulation.time());
}

void print_no_slip(Simulation const& simulation) {
  auto const residual = no_slip_of(simulation, {simulation.time(), simulation.frame()});
  if (!residual) return;
  if (residual->is_at_rest()) return fmt::print(stderr, "at rest: no speed at a surface is above 1e-12 um/s\n");
  fmt::print(stderr, "no slip between the nodes: {:.1e} of {:.3g} um/s (bodies {:.1e}, periphery {:.1e} um/s)\n",
             residual->relative(), residual->speed, residual->bodies, residual->periphery);
}

}  // namespace

void store_state(Simulation const& simulation, TrajectoryWriter& trajectory) {
  Frame frame{simulation.time(), simulation.frame()};
  if (auto const residual = no_slip_of(simulation, frame))
    frame.arrays.push_back(
        NamedArray::of("flow/no_slip_residual", std::vector{residual->bodies, residual->periphery, residual->speed}, "um/s"));
  trajectory.append(std::move(frame), simulation.restart());
}

void catch_signals() {
  std::signal(SIGINT, note_signal);
  std::signal(SIGTERM, note_signal);
}

int simulate(Simulation& simulation, TrajectoryWriter& trajectory, std::filesystem::path const& folder) {
  auto const& scene = simulation.scene();
  double const end_time = scene.run.end_time;
  Progress progress(simulation.time(), end_time);
  double stored = simulation.time();
  while (simulation.time() < end_time) {
    if (int const signal = caught_signal) {
      progress.finish();
      if (simulation.time() > stored) store_state(simulation, trajectory);
      fmt::print(stderr, "stopped at t = {:g} s; go on with: asterflow resume {}\n", simulation.time(), folder.string());
      return signal;
    }
    double const until = next_output(simulation.time(), scene.output.interval, end_time);
    try {
      progress.show(simulation.step(until));
    } catch (NumericalError const& error) {
      progress.finish();
      if (simulation.time() > stored) store_state(simulation, trajectory);
      throw NumericalError(fmt::format("{}; the last accepted state is stored, look at it with: {}", error.what(),
                                       way_to_look(simulation, folder)));
    }
    if (simulation.time() >= until) {
      store_state(simulation, trajectory);
      stored = simulation.time();
    }
  }
  progress.finish();
  fmt::print(stderr, "{} steps in {}\n", progress.steps(), duration_words(progress.seconds()));
  print_no_slip(simulation);
  return 0;
}

void draw_last_state(Scene const& scene, std::filesystem::path const& folder) {
  if (!scene.output.picture || scene.run.interactions == Interactions::local) return;
  TrajectoryReader const trajectory(folder);
  Frame const frame = trajectory.frame(trajectory.times().size() - 1);
  if (frame.time == 0.0) return;
  PlanePoints grid = surrounding(scene, frame, Plane{});
  auto const count = [&](int k) {
    return std::clamp(int((grid.upper[k] - grid.lower[k]) / scene.output.picture_spacing) + 1, 20, 2000);
  };
  grid.n_first = count(0), grid.n_second = count(1);
  for (auto const& path : write_plane_flow(plane_flow(scene, frame, grid), frame, folder / "final"))
    fmt::print("{}\n", path.string());
}

}  // namespace asterflow

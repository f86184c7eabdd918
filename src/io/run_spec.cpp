#include "io/run_spec.hpp"

#include "backends/evaluator.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace asterflow {

namespace {

void read_time_steps(Table& table, RunSpec& run) {
  table.read("end_time", run.end_time, not_negative, "s");
  table.read("adaptive", run.adaptive);
  table.read("time_step", run.time_step, positive, "s");
  table.read("min_time_step", run.min_time_step, positive, "s");
  table.read("max_time_step", run.max_time_step, positive, "s");
  table.read("step_tolerance", run.step_tolerance, positive, "um");
  if (!run.adaptive) {
    for (char const* key : {"min_time_step", "max_time_step", "step_tolerance"})
      if (table.has(key)) table.fail(key, "has no use with adaptive = false");
    run.min_time_step = run.max_time_step = run.time_step;
  }
  if (run.min_time_step > run.max_time_step) table.fail("min_time_step", "must not exceed max_time_step (s)");
  if (!table.has("time_step")) run.time_step = std::clamp(run.time_step, run.min_time_step, run.max_time_step);
  if (run.min_time_step > run.time_step) table.fail("min_time_step", "must not exceed time_step (s)");
  if (run.max_time_step < run.time_step) table.fail("max_time_step", "must not be below time_step (s)");
}

}  // namespace

std::string_view name_of(Interactions level) {
  switch (level) {
    case Interactions::local: return "local";
    case Interactions::open: return "open";
    case Interactions::confined: break;
  }
  return "confined";
}

void RunSpec::set_defaults_from_accuracy() {
  if (step_tolerance == 0.0) step_tolerance = accuracy;
  if (gmres_tolerance == 0.0) gmres_tolerance = accuracy / 10.0;
  if (evaluator_accuracy == 0.0) evaluator_accuracy = std::clamp(accuracy / 10.0, 1e-15, 1e-3);
}

RunSpec read_run(Table table, bool has_periphery, bool fibers_touch_bodies) {
  using enum Interactions;
  RunSpec run;
  if (has_periphery) run.interactions = confined;
  if (fibers_touch_bodies) run.images = ImagesBehind::everything;
  table.read_choice<Interactions>("interactions", run.interactions,
                                  {{"local", local}, {"open", open}, {"confined", confined}});
  if (run.interactions == confined && !has_periphery)
    table.fail("interactions", "needs a [periphery]; without one choose local or open");
  table.read("accuracy", run.accuracy, between(1e-10, 1e-1));
  read_time_steps(table, run);
  table.read("gmres_tolerance", run.gmres_tolerance, between(1e-14, 1e-1));
  table.read("gmres_max_iterations", run.gmres_max_iterations, between(1, 10000));
  table.read("evaluator", run.evaluator);
  auto const known = backend_names();
  if (std::find(known.begin(), known.end(), run.evaluator) == known.end())
    table.fail("evaluator", fmt::format("must be one of {}", fmt::join(known, ", ")));
  table.read("evaluator_accuracy", run.evaluator_accuracy, between(1e-15, 1e-3));
  table.read_choice<ImagesBehind>("images", run.images,
                                  {{"none", ImagesBehind::nothing},
                                   {"periphery", ImagesBehind::periphery},
                                   {"all", ImagesBehind::everything}});
  table.read("seed", run.seed);
  table.finish();
  run.set_defaults_from_accuracy();
  return run;
}

}  // namespace asterflow

#pragma once
// How a scene is solved and for how long: the table [run]. `accuracy` sets everything that is not set by its own key.

#include "base/table.hpp"

#include <cstdint>
#include <string>

namespace asterflow {

// Who feels whose flow. local: nobody; open: fibers and bodies; confined: fibers, bodies and the periphery.
enum class Interactions { local, open, confined };

std::string_view name_of(Interactions level);

// Which surfaces the forces of fibers close to them get images behind (docs/accuracy.md).
enum class ImagesBehind { nothing, periphery, everything };

struct RunSpec {
  Interactions interactions = Interactions::open;  // confined when the scene has a periphery
  double accuracy = 1e-4;       // relative, 1e-10 to 1e-1
  double end_time = 60.0;       // s, >= 0
  bool adaptive = true;         // the time step follows from the error; false: time_step throughout
  double time_step = 0.01;      // s, > 0, the first one, or every one
  double min_time_step = 1e-6;  // s, > 0; a run that needs less stops with its state saved
  double max_time_step = 5.0;   // s, > 0
  double step_tolerance = 0.0;  // um, error of positions a step may make (Fibers::error_estimate); 0: accuracy x 1 um
  double gmres_tolerance = 0.0;    // relative residual; 0: accuracy / 10
  int gmres_max_iterations = 200;  // > 0; a solve that needs more is a failed step
  std::string evaluator = "auto";  // auto, reference, direct, fast: who sums pairs (asterflow sum --help)
  double evaluator_accuracy = 0.0;  // relative error of pair sums; 0: accuracy / 10
  ImagesBehind images = ImagesBehind::periphery;  // everything when fibers are repelled by bodies
  std::uint64_t seed = 1;          // of all chance

  void set_defaults_from_accuracy();  // replaces the zeros
};

RunSpec read_run(Table table, bool has_periphery, bool fibers_touch_bodies);

}  // namespace asterflow

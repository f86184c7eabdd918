#pragma once
// The drag study, the paper's Figure 2a: drag of a body with its fibers against their number, for several levels of
// interaction, relative to the same body alone in unbounded fluid,
//   translation  F / (gamma_0 U),  rotation  T / (gamma_0R Omega),   sphere: gamma_0 = 6 pi mu a, gamma_0R = 8 pi mu a^3.
// Two runs a point, one with the force and one with the torque: the fibers grow, shrink and bend as they do in `run`.
// U and Omega are means over the measurement, along force and torque.

#include "io/scene.hpp"

#include <functional>

namespace asterflow {

struct DragPoint {
  Interactions level = Interactions::open;
  int fiber_count = 0;
  double translation = 0.0, rotation = 0.0;                // relative drag
  double translation_spread = 0.0, rotation_spread = 0.0;  // standard deviation over the samples of the measurement
  double iterations = 0.0, inner_iterations = 0.0;         // GMRES with accurate and with rough sums, mean per step
  int steps = 0;
  double seconds = 0.0;  // wall time
};

// Calls `done` after each point and `progress` after each step (fraction of the point, 0 to 1). Leaves out the points
// (level, number of fibers) that are known.
void drag_study(Scene const& scene, std::function<bool(Interactions, int)> const& is_known,
                std::function<void(DragPoint const&)> const& done,
                std::function<void(DragPoint const&, double)> const& progress);

}  // namespace asterflow

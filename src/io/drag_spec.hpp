#pragma once
// The drag study, the paper's Figure 2: the table [drag]. A body with its fibers is pulled, then turned; drag is
//   translation  F / (6 pi mu a U),  rotation  T / (8 pi mu a^3 Omega)
// with U, Omega the mean velocities along force and torque while fibers grow and shrink.

#include "io/run_spec.hpp"

#include <string>
#include <vector>

namespace asterflow {

struct DragSpec {
  std::string body;               // which one; the only body of the scene when not given
  std::vector<int> fiber_counts = {0, 100, 200, 400, 600, 800, 1000, 1200};  // N_MT, each shared evenly by the asters
  std::vector<Interactions> levels = {Interactions::local, Interactions::open, Interactions::confined};
  Vec3d force{10.0, 0.0, 0.0};    // pN, for translation
  Vec3d torque{0.0, 0.0, 50.0};   // pN um, for rotation
  double settling_time = 20.0;    // s, >= 0, before the measurement
  double duration = 20.0;         // s, > 0, of the measurement
  int samples = 5;                // states of the measurement, equally spaced in time, at least 1
};

DragSpec read_drag(Table table);

}  // namespace asterflow

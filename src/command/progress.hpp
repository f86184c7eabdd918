#pragma once
// The live line of a run on stderr: time, step, dt, GMRES iterations, residual, seconds per step, remaining.
// On a terminal it rewrites itself; elsewhere it is a new line at most every ten seconds.

#include "base/timer.hpp"
#include "system/simulation.hpp"

#include <string>

namespace asterflow {

class Progress {
 public:
  Progress(double start_time, double end_time);  // s, of the simulation

  void show(StepReport const& step);
  void finish();  // leaves the last line standing

  long steps() const { return n_step_; }
  double seconds() const { return timer_.seconds(); }

 private:
  double start_time_, end_time_;
  Timer timer_;
  double last_shown_ = -1e9;  // s of wall time
  long n_step_ = 0;
  bool is_terminal_;
  std::string line_;
};

// "45 s", "12 min 5 s", "3 h 20 min"
std::string duration_words(double seconds);

}  // namespace asterflow

#include "command/progress.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <unistd.h>

namespace asterflow {

std::string duration_words(double seconds) {
  long const s = std::lround(std::clamp(seconds, 0.0, 1e9));
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {} s", s / 60, s % 60);
  return fmt::format("{} h {} min", s / 3600, s / 60 % 60);
}

Progress::Progress(double start_time, double end_time)
    : start_time_(start_time), end_time_(end_time), is_terminal_(isatty(STDERR_FILENO)) {}

void Progress::show(StepReport const& step) {
  ++n_step_;
  double const now = timer_.seconds();
  double const done = step.time - start_time_;
  double const remaining = done > 0.0 ? now * (end_time_ - step.time) / done : 0.0;
  line_ = fmt::format("t {:.4g} of {:g} s   step {}   dt {:.3g} s   GMRES {}+{} ({:.1e})   {:.3g} s/step   {} left", step.time,
                      end_time_, n_step_, step.dt, step.iterations, step.inner_iterations, step.residual, now / double(n_step_),
                      duration_words(remaining));
  if (is_terminal_ && now - last_shown_ > 0.1) {
    fmt::print(stderr, "\r\033[K{}", line_);
    last_shown_ = now;
  } else if (!is_terminal_ && now - last_shown_ > 10.0) {
    fmt::print(stderr, "{}\n", line_);
    last_shown_ = now;
  }
}

void Progress::finish() {
  if (line_.empty()) return;
  fmt::print(stderr, "{}{}\n", is_terminal_ ? "\r\033[K" : "", line_);
  line_.clear();
}

}  // namespace asterflow

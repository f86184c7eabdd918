#pragma once
// asterflow sum: pair sums over a user's own points, with time, rate and (on request) error.

#include "command/command.hpp"

namespace asterflow {

void add_sum_command(CLI::App& program, Action& chosen);

}  // namespace asterflow

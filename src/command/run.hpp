#pragma once
// asterflow run: simulates a scene and writes a trajectory.

#include "command/command.hpp"

namespace asterflow {

void add_run_command(CLI::App& program, Action& chosen);

}  // namespace asterflow

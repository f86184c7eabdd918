#pragma once
// asterflow resume: goes on with an interrupted run exactly.

#include "command/command.hpp"

namespace asterflow {

void add_resume_command(CLI::App& program, Action& chosen);

}  // namespace asterflow

#pragma once
// asterflow check: validates a scene and prints what will be modelled and what it costs.

#include "command/command.hpp"

namespace asterflow {

void add_check_command(CLI::App& program, Action& chosen);

}  // namespace asterflow

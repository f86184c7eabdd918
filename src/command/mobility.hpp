#pragma once
// asterflow mobility: resistance and mobility of every body in the scene as it stands, as JSON.

#include "command/command.hpp"

namespace asterflow {

void add_mobility_command(CLI::App& program, Action& chosen);

}  // namespace asterflow

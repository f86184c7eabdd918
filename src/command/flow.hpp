#pragma once
// asterflow flow: velocity in a plane of a stored state, as numbers and as a picture.

#include "command/command.hpp"

namespace asterflow {

void add_flow_command(CLI::App& program, Action& chosen);

}  // namespace asterflow

#pragma once
// asterflow drag: the Figure 2 study, drag against the number of fibers for each level of interactions.

#include "command/command.hpp"

namespace asterflow {

void add_drag_command(CLI::App& program, Action& chosen);

}  // namespace asterflow

#pragma once
// asterflow observe: what a trajectory shows, as tables and a picture (observable/).

#include "command/command.hpp"

namespace asterflow {

void add_observe_command(CLI::App& program, Action& chosen);

}  // namespace asterflow

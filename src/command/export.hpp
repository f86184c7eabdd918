#pragma once
// asterflow export: a trajectory as files for ParaView.

#include "command/command.hpp"

namespace asterflow {

void add_export_command(CLI::App& program, Action& chosen);

}  // namespace asterflow

#pragma once
// asterflow torque: the torque instability of cortical pushing (system/torque_instability.hpp).

#include "command/command.hpp"

namespace asterflow {

void add_torque_command(CLI::App& program, Action& chosen);

}  // namespace asterflow

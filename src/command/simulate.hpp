#pragma once
// The loop of `run` and `resume`: steps to the end of the scene's time, stores states, shows progress.

#include "io/trajectory.hpp"
#include "system/simulation.hpp"

#include <filesystem>

namespace asterflow {

// Stores the present state.
void store_state(Simulation const& simulation, TrajectoryWriter& trajectory);

// Steps to the end. A failed solve stores the last accepted state and rethrows with the way to look at it. An interrupt
// (Ctrl-C) or a request to terminate stores the state after the present step and ends the program.
void simulate(Simulation& simulation, TrajectoryWriter& trajectory, std::filesystem::path const& folder);

}  // namespace asterflow

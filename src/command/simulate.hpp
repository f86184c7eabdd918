#pragma once
// The loop of `run` and `resume`: steps to the end of the scene's time, stores states, shows progress.

#include "io/trajectory.hpp"
#include "system/simulation.hpp"

#include <filesystem>

namespace asterflow {

// Stores the present state.
void store_state(Simulation const& simulation, TrajectoryWriter& trajectory);

// From here on an interrupt (Ctrl-C) or a request to terminate waits for the present step.
void catch_signals();

// Steps to the end. A failed solve stores the last accepted state and rethrows with the way to look at it. A caught
// signal stores the state after the present step and ends the loop: it is returned, for the caller to raise once
// everything is closed; 0 when the end was reached.
int simulate(Simulation& simulation, TrajectoryWriter& trajectory, std::filesystem::path const& folder);

// Draws the last state of a finished run: FOLDER/final.h5, .vts, .png. Nothing without flow or when the scene says so.
void draw_last_state(Scene const& scene, std::filesystem::path const& folder);

}  // namespace asterflow

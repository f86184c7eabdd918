#pragma once
// Points of the fluid in a stored state at which its flow is summarised; the same ones for the same state.

#include "io/scene.hpp"
#include "io/trajectory.hpp"
#include "observable/stored_fibers.hpp"

namespace asterflow {

struct FluidSamples {
  PointArray spread;     // [n] um, evenly in the fluid, not closer than 0.3 um to a surface
  PointArray anterior;   // [n] um, in a cylinder of half the first body's radius on its -x side, up to the periphery
  PointArray posterior;  // [n] um, on its +x side
  PointArray beside_fibers, fiber_directions;  // [n] um, 0.75 um from nodes of the fibers; their directions there
};

// Without a periphery the fluid ends at 4 radii from the first body (10 um without bodies).
FluidSamples fluid_samples(Scene const& scene, Frame const& frame, StoredFibers const& fibers);

}  // namespace asterflow

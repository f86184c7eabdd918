#pragma once
// A scene file (TOML) as plain data: what is there, how it is solved, what is written. A table that the file does
// not have leaves an empty list or no value, and nothing is built from it. Lengths in um, times in s, forces in pN.
//
//   [fluid] [background] [periphery] [[body]] [[fiber]] [[aster]] [dynamic_instability] [cytoplasmic_pulling]
//   [pushing] [cortical_pulling] [steric_repulsion] [run] [output] [drag]

#include "background/background_spec.hpp"
#include "body/body_spec.hpp"
#include "fiber/dynamic_instability_spec.hpp"
#include "fiber/fiber_spec.hpp"
#include "io/drag_spec.hpp"
#include "io/fluid_spec.hpp"
#include "io/output_spec.hpp"
#include "io/run_spec.hpp"
#include "mechanism/cortical_pulling_spec.hpp"
#include "mechanism/cytoplasmic_pulling_spec.hpp"
#include "mechanism/pushing_spec.hpp"
#include "mechanism/steric_repulsion_spec.hpp"
#include "periphery/periphery_spec.hpp"

#include <optional>
#include <string>
#include <vector>

namespace asterflow {

struct Scene {
  FluidSpec fluid;
  RunSpec run;
  OutputSpec output;
  DragSpec drag;
  std::optional<PeripherySpec> periphery;
  std::optional<BackgroundSpec> background;
  std::vector<BodySpec> bodies;
  std::vector<FiberSpec> fibers;
  std::vector<AsterSpec> asters;
  std::optional<DynamicInstabilitySpec> dynamic_instability;  // of fibers and asters with growing = true
  std::optional<CytoplasmicPullingSpec> cytoplasmic_pulling;
  std::optional<PushingSpec> pushing;                  // of growing plus ends against the cortex
  std::optional<CorticalPullingSpec> cortical_pulling;
  std::optional<StericRepulsionSpec> steric_repulsion;

  std::string file;                    // as the user wrote it
  std::string text;                    // all of it, kept with the trajectory
  std::vector<std::string> overrides;  // "table.key=value", applied to it
};

// Index of the body of that name; -1 for an empty name. Throws std::out_of_range when there is none.
int body_index(Scene const& scene, std::string const& name);

// Reads and validates, including what involves several objects. Throws SceneError.
Scene read_scene(std::string const& file, std::vector<std::string> const& overrides = {});

// The same from a text that is already in memory, such as that of a trajectory.
Scene parse_scene(std::string const& text, std::string const& file, std::vector<std::string> const& overrides = {});

}  // namespace asterflow

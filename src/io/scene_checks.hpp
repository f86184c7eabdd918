#pragma once
// Checks of a scene that involve several of its objects. Each throws a SceneError that names the object at fault.

#include "base/table.hpp"
#include "io/scene.hpp"

#include <vector>

namespace asterflow {

// The tables that the specs of a scene were read from, in the same order.
struct SceneTables {
  std::vector<Table> bodies, fibers, asters;
  Table drag;
  std::optional<Table> pushing, cortical_pulling;
};

void check_names(SceneTables const& tables, Scene const& scene);
void check_growth(SceneTables const& tables, Scene const& scene);
// A fiber's own flow is exchanged with the flows of all others.
void check_nonlocal(SceneTables const& tables, Scene const& scene);
// What plus ends do at the cortex needs a cortex and plus ends that grow.
void check_cortex_mechanisms(SceneTables const& tables, Scene const& scene);
void check_places(SceneTables const& tables, Scene const& scene);

}  // namespace asterflow

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
  std::optional<Table> dynamic_instability, cytoplasmic_pulling, pushing, cortical_pulling, steric_repulsion;
};

void check_names(SceneTables const& tables, Scene const& scene);
void check_growth(SceneTables const& tables, Scene const& scene);
// A fiber's own flow is exchanged with the flows of all others.
void check_nonlocal(SceneTables const& tables, Scene const& scene);
// A mechanism needs something to act on, and a cell that is larger than its range.
void check_mechanisms(SceneTables const& tables, Scene const& scene);
void check_places(SceneTables const& tables, Scene const& scene);

}  // namespace asterflow

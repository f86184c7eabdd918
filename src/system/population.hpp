#pragma once
// The fibers of a scene: single ones, those of asters, and the growth of those that grow.

#include "fiber/fibers.hpp"
#include "io/scene.hpp"
#include "system/plus_ends.hpp"

#include <optional>

namespace asterflow {

// Adds the scene's fibers in the order of the file, single ones first; growing ones to `growth` as well. The fibers of
// an aster end at the first surface that they meet.
void add_scene_fibers(Scene const& scene, Fibers& fibers, std::optional<PlusEnds>& growth);

}  // namespace asterflow

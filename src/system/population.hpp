#pragma once
// The fibers of a scene: single ones, those of asters, and the growth of those that grow.

#include "fiber/dynamic_instability.hpp"
#include "fiber/fibers.hpp"
#include "io/scene.hpp"
#include "io/scene_geometry.hpp"

#include <optional>

namespace asterflow {

// Adds the scene's fibers in the order of the file, single ones first; growing ones to `growth` as well. The fibers of
// an aster end at the first surface that they meet.
void add_scene_fibers(Scene const& scene, Fibers& fibers, std::optional<DynamicInstability>& growth);

// What growing plus ends meet in the next step: the cortex, where they stop growing.
class GrowthSurroundings {
 public:
  explicit GrowthSurroundings(Scene const& scene);  // needs a periphery to have an effect

  // [n_tip], in the order of growth.tips(); empty without a periphery. `motions` [n_body]: velocity, angular velocity.
  std::vector<TipSurroundings> at_tips(Fibers const& fibers, DynamicInstability const& growth,
                                       std::span<RigidPose const> poses, std::span<Vector6 const> motions) const;

 private:
  std::shared_ptr<Shape const> cortex_;
};

}  // namespace asterflow

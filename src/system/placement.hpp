#pragma once
// Whether bodies and fibers are where they may be: bodies apart from each other and inside the periphery, and where
// flows are exchanged, fibers in the fluid. A step that violates this is rejected (simulation.hpp).

#include "body/rigid_body.hpp"
#include "fiber/fibers.hpp"
#include "io/scene.hpp"
#include "surface/shapes.hpp"

#include <memory>
#include <string>
#include <vector>

namespace asterflow {

// "fiber 7 (of [[aster]] #2 on body "pnc")": fibers as the scene made them, counted from 1.
std::string fiber_words(Scene const& scene, std::size_t fiber);

class Placement {
 public:
  explicit Placement(Scene const& scene);

  // Each returns what is wrong with the first object at fault, "" when nothing is.
  std::string complaint(std::span<RigidPose const> bodies) const;
  //   positions [n]: nodes or ends of that fiber, um
  std::string complaint(std::size_t fiber, ConstPoints positions, std::span<RigidPose const> bodies) const;

  bool checks_fibers() const { return checks_fibers_; }

 private:
  Scene const& scene_;
  std::vector<std::shared_ptr<Shape const>> bodies_;
  std::shared_ptr<Shape const> periphery_;  // null: none
  bool checks_fibers_, checks_fibers_inside_;
};

}  // namespace asterflow

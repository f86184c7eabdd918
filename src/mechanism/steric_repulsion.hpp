#pragma once
// Steric repulsion: a linear contact force over a short range, for a distance d < d* from the other surface,
//   fiber     f = -f_0 (1 - d / d*) n   per length, n: from the fiber into the surface
//   body      F = -F_0 (1 - d / d*) n   at the point of the body that is closest to the cortex
// Implicit: a fiber's contacts are found by repeating its local answer until the nodes in contact are those that repel;
// a body's contact enters its equation of motion as a spring along n.

#include "base/rigid.hpp"
#include "mechanism/steric_repulsion_spec.hpp"
#include "surface/shapes.hpp"

#include <memory>
#include <span>
#include <vector>

namespace asterflow {

class Fibers;
struct NodeLoad;

// Load on a body that moves with q: load - resistance q.
struct ContactLoad {
  Vector6 load = Vector6::Zero();
  Matrix6 resistance = Matrix6::Zero();
};

class StericRepulsion {
 public:
  // `cortex` may be null.
  StericRepulsion(StericRepulsionSpec const& spec, std::shared_ptr<Shape const> cortex,
                  std::vector<std::shared_ptr<Shape const>> bodies);

  // Loads on the nodes of fibers, after prepare; u [n_node]: incident flow, extrapolated.
  void hold(Fibers& fibers, ConstPoints u, std::span<BodyMotionMap const> bodies) const;
  // On a body by the cortex.
  ContactLoad on_body(std::size_t body, BodyMotionMap const& map) const;

 private:
  // Loads at those positions, linear about them, for displacements from `predicted`; false: none.
  bool node_loads(Fibers const& fibers, std::size_t fiber, ConstPoints predicted, ConstPoints positions,
                  std::span<BodyMotionMap const> bodies, std::vector<NodeLoad>& loads) const;
  void hold(Fibers& fibers, std::size_t fiber, ConstPoints u, std::span<BodyMotionMap const> bodies) const;

  StericRepulsionSpec spec_;
  std::shared_ptr<Shape const> cortex_;
  std::vector<std::shared_ptr<Shape const>> bodies_;
};

}  // namespace asterflow

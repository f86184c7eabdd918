#pragma once
// Steric repulsion: a linear contact force over a short range, for a distance d < d* from the other surface,
//   fiber     f = -f_0 (1 - d / d*) n   per length, n: from the fiber into the surface of the cortex or of a body
//   body      F = -F_0 (1 - d / d*) n   at the point of the body that is closest to the cortex
// Implicit: fibers as in mechanism/fiber_contacts.hpp; a body's contact with the cortex enters its equation of motion as a
// spring along n.

#include "base/rigid.hpp"
#include "mechanism/steric_repulsion_spec.hpp"
#include "surface/shapes.hpp"

#include <memory>
#include <span>
#include <vector>

namespace asterflow {

class Fibers;

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

  // Loads on fibers, after prepare; u [n_node]: incident flow, extrapolated.
  void hold(Fibers& fibers, ConstPoints u, std::span<BodyMotionMap const> bodies);
  // On a body, by the cortex and, as hold() has found them, by fibers that it does not hold.
  ContactLoad on_body(std::size_t body, BodyMotionMap const& map) const;

 private:
  StericRepulsionSpec spec_;
  std::shared_ptr<Shape const> cortex_;
  std::vector<std::shared_ptr<Shape const>> bodies_;
  std::vector<Vector6> fiber_loads_;  // [n_body] pN, pN um, of fibers that they do not hold
};

}  // namespace asterflow

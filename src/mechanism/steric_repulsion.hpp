#pragma once
// Steric repulsion: a linear contact force over a short range, for a distance d < d* from the other surface,
//   fiber     f = -f_0 (1 - d / d*) n   per length, n: from the fiber into the surface of the cortex or of a body
//   body      F = -F_0 (1 - d / d*) n   at the point of the body that is closest to the cortex
// Implicit: fibers as in mechanism/fiber_contacts.hpp; a body's contact with the cortex enters its equation of motion as a
// spring along n; where bodies touch fibers that they do not hold, the forces are those of a balance K q = load of all bodies
// and fibers, each answering by itself to the flow that is expected.

#include "base/rigid.hpp"
#include "mechanism/steric_repulsion_spec.hpp"
#include "surface/shapes.hpp"

#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace asterflow {

class Fibers;
struct TipLoad;

// Load on a body that moves with q: load - resistance q.
struct ContactLoad {
  Vector6 load = Vector6::Zero();
  Matrix6 resistance = Matrix6::Zero();
};

// How bodies move by themselves, with the fibers that they hold as these are loaded now, in the flow that is expected.
struct LocalMotions {
  std::vector<Vector6> motions;      // of prescribed bodies too
  std::vector<Matrix6> resistances;  // zero: prescribed
};

class StericRepulsion {
 public:
  // `cortex` may be null.
  StericRepulsion(StericRepulsionSpec const& spec, std::shared_ptr<Shape const> cortex,
                  std::vector<std::shared_ptr<Shape const>> bodies);

  // Loads on fibers, after prepare; u [n_node]: incident flow, extrapolated. Returns the loads (pN, pN um) on the bodies [n_body]
  // by fibers that they do not hold.
  std::vector<Vector6> hold(Fibers& fibers, ConstPoints u, std::span<BodyMotionMap const> bodies,
                            std::function<LocalMotions()> const& local_motions) const;
  // On a body by the cortex.
  ContactLoad on_body(std::size_t body, BodyMotionMap const& map) const;

 private:
  struct BodyContacts {  // with fibers that they do not hold
    std::vector<ContactLoad> loads;  // [n_body]
    bool any = false;
  };
  BodyContacts hold(Fibers& fibers, ConstPoints u, std::span<BodyMotionMap const> bodies, std::span<Vector6 const> motions,
                    std::span<TipLoad const> free_tips) const;

  StericRepulsionSpec spec_;
  std::shared_ptr<Shape const> cortex_;
  std::vector<std::shared_ptr<Shape const>> bodies_;
};

}  // namespace asterflow

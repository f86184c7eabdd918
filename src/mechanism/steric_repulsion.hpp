#pragma once
// Steric repulsion: a linear contact force over a short range, for a distance d < d* from the other surface,
//   fiber     f = -f_0 (1 - d / d*) n   per length, n: from the fiber into the surface of the cortex or of a body
//   body      F = -F_0 (1 - d / d*) n   at the point of the body that is closest to the cortex; of two bodies, halfway between them
// Implicit: fibers as in mechanism/fiber_contacts.hpp; contacts of bodies with the cortex and each other enter their equations of
// motion as springs along n; where bodies touch fibers that they do not hold, the forces are those of a balance K q = load of all bodies
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

// Loads on all bodies, which feel each other's motions too: load_b - resistance_b q_b - sum over c of between_bc q_c.
struct BodyContacts {
  std::vector<ContactLoad> loads;  // [n_body]
  Eigen::MatrixXd between;         // [6 n_body, 6 n_body], zero on the diagonal; empty: no bodies touch each other

  Vector6 load(std::size_t body, std::span<Vector6 const> motions) const;
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
  // On bodies by the cortex and by each other.
  BodyContacts on_bodies(std::span<BodyMotionMap const> maps) const;

 private:
  struct FiberLoads {  // on bodies, by fibers that they do not hold
    std::vector<ContactLoad> loads;  // [n_body]
    bool any = false;
  };
  FiberLoads hold(Fibers& fibers, ConstPoints u, std::span<BodyMotionMap const> bodies, std::span<Vector6 const> motions,
                  std::span<TipLoad const> free_tips) const;
  void add_cortex(std::size_t body, BodyMotionMap const& map, ContactLoad& load) const;
  void add_pair(std::size_t one, std::size_t other, std::span<BodyMotionMap const> maps, BodyContacts& contacts) const;

  StericRepulsionSpec spec_;
  std::shared_ptr<Shape const> cortex_;
  std::vector<std::shared_ptr<Shape const>> bodies_;
};

}  // namespace asterflow

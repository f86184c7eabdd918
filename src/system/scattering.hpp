#pragma once
// The coupled problem of one time level, as multiple scattering. The unknown is z, the incident flow at all nodes
// (velocity due to all OTHER objects and the background). Objects answer to z locally and exactly,
//   f = f_0 + R z + C q       fibers, elastic and inextensible, on bodies that move with q = (U, Omega)
//   (K + sum S) q = F_ext + faxen(z) + sum (l_0 + D z)      each free body with the fibers that it holds; where bodies touch
//                                                           each other, all of these together
// and their flows make up the incident flow of the others:
//   z = exchange(f(z), q(z), z) + background  =:  L z + b,
// where bodies answer to what reaches them from z, not to z (system/radiation.hpp).
// To a nonlocal fiber the nonlocal part of its own flow (fiber/own_flow.hpp) counts as incident.
// GMRES solves (I - L) z = b. Where the sums are to be accurate, its preconditioner is GMRES on the same equation with rough
// sums, which cost a fraction: each outer iteration gains the digits that rough sums have. The rough equation is
// preconditioned by what earlier solves have learnt (linalg/recycling.hpp): an aster as a whole yields to a flow far more
// easily than its fibers do one by one, and these few collective motions change little from step to step.
// Without interactions (`local`) nothing is exchanged and z is the background.

#include "linalg/gmres.hpp"
#include "linalg/recycling.hpp"
#include "system/radiation.hpp"

#include <Eigen/LU>
#include <optional>
#include <span>

namespace asterflow {

// How all fibers answer, at their hydrodynamic nodes. Loads [n_body] are force (pN) and torque about the centre (pN um).
class FiberAnswers {
 public:
  virtual ~FiberAnswers() = default;
  virtual FiberNodes nodes() const = 0;
  // f += R u + C q, loads += D u - S q; empty: no loads are wanted
  virtual void add_linear_response(ConstPoints u, std::span<Vector6 const> motions, Points f,
                                   std::span<Vector6> loads) const = 0;
  // loads += D u
  virtual void add_loads(ConstPoints u, std::span<Vector6> loads) const = 0;
  // u += what fibers feel of their own force density beyond local drag
  virtual void add_own_flow(ConstPoints force_density, Points u) const = 0;
  // f += f_0, loads += l_0
  virtual void add_affine_response(Points f, std::span<Vector6> loads) const = 0;
  // f += forces that go along with the fibers and that only others feel
  virtual void add_dipoles(Points) const {}
  // resistances += sum of S over the fibers that a body holds
  virtual void add_body_resistance(std::span<Matrix6> resistances) const = 0;
};

// One body: where it is, its own resistance K, and what drives it.
struct BodyDrive {
  RigidPose pose;
  Matrix6 resistance;  // pN s/um, pN s, pN s um
  bool is_free = true;
  Vector6 value = Vector6::Zero();  // free: external load, pN and pN um; else: motion, um/s and 1/s
};

struct ScatteringOptions {
  double tolerance = 1e-6;  // relative residual of z
  int max_iterations = 200;
  double rough_gain = 1e-3;  // factor by which a solve with rough sums can lower the residual
};

struct ScatteringSolution {
  PointArray incident;           // z, um/s
  PointArray force_density;      // pN/um, on the fluid, at the fibers' nodes
  std::vector<Vector6> motions;  // q
  std::vector<Vector6> holders;  // [n_body] load that makes a prescribed body move so; zero: free
  PointArray fiber_nodes;        // um, where all this was solved
  std::vector<RigidPose> poses;
  GmresResult gmres;             // with accurate sums
  int inner_iterations = 0;      // with rough sums
};

// What a sequence of similar problems remembers: more directions save few iterations (bench_step).
inline constexpr int recycled_directions = 45;

class Scattering {
 public:
  // The problem at the geometry that fibers and bodies have now. `radiation` must have been made for these bodies; null:
  // no interactions. `memory` of earlier solves is used and added to; it may be null.
  Scattering(FiberAnswers const& fibers, std::vector<BodyDrive> bodies, Radiation* radiation, Recycling* memory,
             ScatteringOptions options);

  ConstPoints nodes() const;  // where z lives; without interactions the fibers' nodes

  // Of a body with the fibers that it holds, at fixed incident flow.
  Matrix6 resistance(std::size_t body) const { return held_resistance_[body].reconstructedMatrix(); }

  // Bodies that feel each other's motions q: between [6 n_body, 6 n_body] q is taken off their loads; zero on the diagonal, empty: none.
  void couple(Eigen::MatrixXd const& between);

  // Changes what drives a body.
  void set_drive(std::size_t body, Vector6 const& value) { bodies_[body].value = value; }

  // `background` is an imposed flow at the nodes, `guess` a z to start from; either may be empty.
  ScatteringSolution solve(ConstPoints background, ConstPoints guess);

  // The local answer to an incident flow: loads from bodies and fibers -> motions -> force densities.
  //   u [n_fiber_node], faxen_loads [n_body]; affine: with what remains at zero flow
  void answer(ConstPoints u, std::vector<Vector6> faxen_loads, bool affine, Points force_density,
              std::vector<Vector6>& motions) const;

 private:
  std::vector<Vector6> holders(ConstPoints u, std::vector<Vector6> faxen_loads, std::span<Vector6 const> motions) const;
  void move_bodies(std::vector<Vector6> const& loads, bool affine, std::vector<Vector6>& motions) const;
  // received += what all objects send in answer to z; affine: with what remains at zero flow
  void add_answer(ConstPoints z, bool affine, Points received, Exchange kind) const;
  // result = (I - L) z
  void apply_equation(ConstVector z, Vector result, Exchange kind) const;
  GmresResult correct(ConstVector residual, double reference, Vector correction, int& inner_iterations);

  FiberAnswers const& fibers_;
  std::vector<BodyDrive> bodies_;
  std::vector<bool> is_free_;
  std::vector<Eigen::PartialPivLU<Matrix6>> held_resistance_;  // K + sum S
  std::optional<Eigen::PartialPivLU<Eigen::MatrixXd>> coupled_;  // the same of all bodies; prescribed ones: identity
  Radiation* radiation_;
  Recycling* memory_;
  ScatteringOptions options_;
};

}  // namespace asterflow

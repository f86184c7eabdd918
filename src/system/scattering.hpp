#pragma once
// The coupled problem of one time level, as multiple scattering. The unknown is z, the incident flow at all nodes
// (velocity due to all OTHER objects and the background). Objects answer to z locally and exactly,
//   f = f_0 + R z + C q       fibers, elastic and inextensible, on bodies that move with q = (U, Omega)
//   (K + sum S) q = F_ext + faxen(z) + sum (l_0 + D z)      each free body with the fibers that it holds
// and their flows make up the incident flow of the others:
//   z = exchange(f(z), q(z), z) + background  =:  L z + b.
// GMRES solves (I - L) z = b. Its preconditioner solves the same problem on coarse nodes (P prolongs, P+ restricts),
// with sums of low accuracy, to a loose tolerance:  M r = r + P ((I - L_c)^-1 - I) P+ r.
// Without interactions (`local`) nothing is exchanged and z is the background.

#include "linalg/gmres.hpp"
#include "system/radiation.hpp"

#include <Eigen/LU>
#include <memory>
#include <span>

namespace asterflow {

class CoarseScattering;

// How all fibers answer, at their hydrodynamic nodes. Loads [n_body] are force (pN) and torque about the centre (pN um).
class FiberAnswers {
 public:
  virtual ~FiberAnswers() = default;
  virtual FiberNodes nodes() const = 0;
  // f += R u + C q, loads += D u - S q
  virtual void add_linear_response(ConstPoints u, std::span<Vector6 const> motions, Points f,
                                   std::span<Vector6> loads) const = 0;
  // f += f_0, loads += l_0
  virtual void add_affine_response(Points f, std::span<Vector6> loads) const = 0;
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
  int coarsening = 2;             // a fiber's nodes over its nodes in the preconditioner; 0: no preconditioner
  double inner_tolerance = 0.2;   // of the coarse solve
  int inner_max_iterations = 40;
};

struct ScatteringSolution {
  PointArray incident;           // z, um/s
  PointArray force_density;      // pN/um, on the fluid, at the fibers' nodes
  std::vector<Vector6> motions;  // q
  GmresResult gmres;
  int inner_iterations = 0;     // of all coarse solves together
  double coarse_seconds = 0.0;  // wall time of the preconditioner
};

// Above this tolerance the coarse solves cost more than the iterations that they save (bench_step).
inline constexpr double loose_tolerance = 1e-5;

class Scattering {
 public:
  // The problem at the geometry that fibers and bodies have now. `radiation` and `coarse` (may be null) must have been
  // made for these bodies; null `radiation`: no interactions.
  Scattering(FiberAnswers const& fibers, std::vector<BodyDrive> bodies, Radiation* radiation, Radiation* coarse,
             ScatteringOptions options);
  ~Scattering();

  ConstPoints nodes() const;  // where z lives; without interactions the fibers' nodes

  // Changes what drives a body.
  void set_drive(std::size_t body, Vector6 const& value) { bodies_[body].value = value; }

  // `background` is an imposed flow at the nodes, `guess` a z to start from; either may be empty.
  ScatteringSolution solve(ConstPoints background, ConstPoints guess);

  // The local answer to an incident flow: loads from bodies and fibers -> motions -> force densities.
  //   u [n_fiber_node], faxen_loads [n_body]; affine: with what remains at zero flow
  void answer(ConstPoints u, std::vector<Vector6> faxen_loads, bool affine, Points force_density,
              std::vector<Vector6>& motions) const;

 private:
  void apply(ConstVector z, Vector result, bool affine) const;

  FiberAnswers const& fibers_;
  std::vector<BodyDrive> bodies_;
  std::vector<Eigen::PartialPivLU<Matrix6>> held_resistance_;  // K + sum S
  Radiation* radiation_;
  std::unique_ptr<CoarseScattering> coarse_;
  ScatteringOptions options_;
};

}  // namespace asterflow

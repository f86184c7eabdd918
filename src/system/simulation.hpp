#pragma once
// A scene in time. One step of dt (second order, adaptive):
//   1 predict   bodies and fibers at the new time; lengths from growth and chance
//   2 solve     the coupled scattering problem at the predicted geometry (scattering.hpp)
//   3 advance   bodies and fibers into a trial state
//   4 judge     all in its place? converged? error below the step tolerance? -> accept; else smaller dt, nothing to
//               restore

#include "background/background_flow.hpp"
#include "body/rigid_body.hpp"
#include "base/named_array.hpp"
#include "fiber/fibers.hpp"
#include "io/scene.hpp"
#include "mechanism/cytoplasmic_pulling.hpp"
#include "mechanism/steric_repulsion.hpp"
#include "system/flows.hpp"
#include "system/placement.hpp"
#include "system/plus_ends.hpp"
#include "system/scattering.hpp"

#include <optional>

namespace asterflow {

// What one accepted step took.
struct StepReport {
  double time = 0.0;         // s, at its end
  double dt = 0.0;           // s
  double error = 0.0;        // um, estimated local error of a position
  int iterations = 0;        // GMRES with accurate sums
  int inner_iterations = 0;  // with rough sums, in its preconditioner
  double residual = 0.0;     // relative
  int rejected = 0;          // trials before it
  double seconds = 0.0;      // wall time, with rejected trials, of which
  double prepare_seconds = 0.0, sum_seconds = 0.0, surface_seconds = 0.0, rough_sum_seconds = 0.0,
         rough_surface_seconds = 0.0;
};

class Simulation {
 public:
  explicit Simulation(Scene scene);
  ~Simulation();

  Scene const& scene() const { return scene_; }
  double time() const { return time_; }  // s
  Fibers const& fibers() const { return fibers_; }
  SceneFlows const& flows() const { return flows_; }
  std::vector<RigidBody> const& bodies() const { return bodies_; }
  std::optional<PlusEnds> const& plus_ends() const { return plus_ends_; }

  // Of a body without its fibers in unbounded fluid, in the given pose.
  Matrix6 resistance_alone(std::size_t body, RigidPose const& pose) const;

  // One accepted step, not beyond `until` (s). Throws NumericalError when no step down to the smallest is accepted;
  // the state is then that of the last accepted step.
  StepReport step(double until);

  // What the plus end of a fiber does; see fibers() for the forces at its ends and the load of its motors.
  TipState tip_state(std::size_t fiber) const;

  // The state, for output.
  std::vector<NamedArray> frame() const;
  // All that a restart needs to go on exactly, and back.
  std::vector<NamedArray> restart() const;
  void restore(double time, std::vector<NamedArray> const& restart);

  std::size_t exchange_memory() const;  // bytes held for the exchange of flows; 0 without interactions

 private:
  struct Trial;
  struct Guess {
    PointArray flow;  // incident, at the nodes; um/s
    bool is_close;    // enough to start GMRES from
  };

  std::vector<NamedArray> body_frame() const;
  std::vector<NamedArray> fiber_frame() const;
  std::vector<NamedArray> fiber_end_frame() const;
  void plan_fibers(double dt);
  BodyContacts hold_fibers(ConstPoints expected, std::vector<BodyMotionMap> const& maps);
  LocalMotions local_motions(ConstPoints expected, std::vector<BodyDrive> const& drives, Eigen::MatrixXd const& between) const;
  BodyContacts contacts(std::vector<BodyMotionMap> const& maps) const;  // of the bodies with the periphery and each other
  std::vector<BodyDrive> drives(std::vector<BodyMotionMap> const& maps, BodyContacts const& contacts) const;
  Trial attempt(double dt, StepReport& report);
  ScatteringSolution solve(ConstPoints guess, std::vector<BodyMotionMap> const& maps,
                           BodyContacts const& contacts, StepReport& report);
  void advance(Trial& trial);
  std::string misplaced_prediction(std::vector<BodyMotionMap> const& maps) const;
  std::string misplaced_trial() const;
  std::string objection(Trial const& trial) const;
  Guess guess(double dt) const;
  void accept(Trial&& trial);

  Scene scene_;
  std::vector<RigidBody> bodies_;
  Fibers fibers_;
  std::optional<PlusEnds> plus_ends_;
  std::optional<StericRepulsion> steric_repulsion_;
  std::optional<CytoplasmicPulling> cytoplasmic_pulling_;
  Placement placement_;
  std::optional<BackgroundFlow> background_;
  SceneFlows flows_;
  std::unique_ptr<Radiation> radiation_;  // null: no interactions
  Recycling memory_{recycled_directions};
  double time_ = 0.0, dt_ = 0.0;                   // s; dt: to try next
  ScatteringSolution last_, before_;               // of the last two accepted steps
  double last_dt_ = 0.0;
  // [n_body] force and torque in the last step: of contacts; of the scene, or of what moves a prescribed body
  std::vector<Vector6> contacts_, applied_;  // pN, pN um
};

}  // namespace asterflow

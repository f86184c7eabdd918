#pragma once
// All flexible fibers of a scene: their shapes at the last accepted times, and one implicit step of all of them.
// A fiber is known by its index for ever. A step goes
//   begin_step();  plan(i) = ...;  prepare(dt, bodies);                     linear problem, geometry of the new time
//   add_affine_response / add_linear_response                              any number of times
//   advance(u, q, poses);  error_estimate();  accept()                     or simply begin again with another dt
// Second order in time (BDF2); a fiber without history makes its first step by backward Euler. See fiber_response.hpp
// for the equations. Flat arrays over nodes are ordered by fiber, nodes from minus to plus end.

#include "base/named_array.hpp"
#include "fiber/centreline.hpp"
#include "fiber/fiber_ends.hpp"
#include "fiber/fiber_response.hpp"
#include "fiber/own_flow.hpp"

#include <optional>
#include <span>
#include <vector>

namespace asterflow {

struct FiberProperties {
  double bending_rigidity = 10.0;  // pN um^2
  double radius = 0.0125;          // um
  FiberLoad load{};                // unless a step plans another one
  TipLoad tip{};
  int n_node = 16;  // hydrodynamic nodes
  bool is_nonlocal = false;
};

// Local slender-body mobility c = ln(1 / (e eps^2)) / (8 pi mu), eps = radius / length, um^2 / (pN s). Slender-body
// theory needs eps << 1; fibers thicker than a quarter of their length keep the value of eps = 1/4.
double slender_body_mobility(double length, double radius, double viscosity);

class Fibers {
 public:
  // What the next step does to one fiber, besides the flow.
  struct Plan {
    double length = 0.0;  // um, at the end of the step
    FiberLoad load;
    TipLoad tip;
    MinusEndSite site;
    std::vector<NodeLoad> node_loads = {};  // [n_node] or none
    Vec3d tip_jump{};      // pN, of the tip's force within the step; `tip` has its mean over the step
    double jump_at = 0.0;  // after this share of the step
    bool is_newborn = false;   // start again as a straight fiber at `site`, wherever it was before
  };

  explicit Fibers(double viscosity);  // pN s / um^2

  // A fiber whose minus end is at its site. Returns its index.
  std::size_t add(FiberProperties const& properties, MinusEndSite const& site, Centreline const& shape);

  std::size_t count() const { return fibers_.size(); }
  std::size_t node_count() const { return nodes_.size(); }
  std::size_t first_node(std::size_t fiber) const { return first_node_[fiber]; }  // also for fiber == count()

  // ---- Step ----
  void begin_step();  // plans: nothing changes
  Plan& plan(std::size_t fiber) { return fibers_[fiber].plan; }
  // `bodies` [n_body] must stay alive until the step ends.
  void prepare(double dt, std::span<BodyMotionMap const> bodies);

  // The same for one fiber whose plan has changed since; fibers in parallel.
  void prepare_again(std::size_t fiber, std::span<BodyMotionMap const> bodies);
  Centreline const& predicted_shape(std::size_t fiber) const { return fibers_[fiber].predicted; }
  // For a given incident flow u [n_node] and motion q of the body that holds the fiber.
  void node_answer(std::size_t fiber, ConstPoints u, Vector6 const& q, Points positions) const;  // overwritten, um
  TipAnswer tip_answer(std::size_t fiber, ConstPoints u, Vector6 const& q) const;

  ConstPoints nodes() const { return nodes_; }      // [n_node] um, predicted for the end of the step
  ConstVector weights() const { return weights_; }  // [n_node] um, quadrature weights along the fibers

  // f [n_node] += R u + C q, loads [n_body] += D u - S q: force density on the fluid (pN/um), force (pN) and torque
  // about the centre (pN um) on the bodies, for the incident flow u [n_node] (um/s) and the bodies' motions q [n_body].
  void add_linear_response(ConstPoints u, std::span<Vector6 const> q, Points f, std::span<Vector6> loads) const;
  // loads [n_body] += D u
  void add_loads(ConstPoints u, std::span<Vector6> loads) const;
  // f += f_0, loads += l_0: what remains at u = 0, q = 0.
  void add_affine_response(Points f, std::span<Vector6> loads) const;
  // resistances [n_body] += S, what attached fibers add to the resistance of their body at fixed incident flow.
  void add_body_resistance(std::span<Matrix6> resistances) const;
  // u [n_node] += what nonlocal fibers feel of the flow of their own force density f [n_node].
  void add_own_flow(ConstPoints f, Points u) const;

  // Trial shapes from the solution and the bodies' poses at the end of the step.
  void advance(ConstPoints u, std::span<Vector6 const> q, std::span<RigidPose const> poses);
  // Local error of the trial step, um: of each fiber the node that errs most, of all fibers the root of the mean
  // square, so that one catastrophe among hundreds does not set the step; at least a tenth of the worst fiber's.
  double error_estimate() const;
  // Whether the tip's force of a fiber on that body jumped in this step or the two before: then what the body's place differs by
  // from its extrapolation is for the most part no error.
  bool has_jumped(int body) const;
  void accept();

  // ---- State at the last accepted time ----
  Centreline const& shape(std::size_t fiber) const { return fibers_[fiber].past[0]; }
  Centreline const& trial_shape(std::size_t fiber) const { return fibers_[fiber].trial; }
  MinusEndSite const& site(std::size_t fiber) const { return fibers_[fiber].site; }
  FiberProperties const& properties(std::size_t fiber) const { return fibers_[fiber].properties; }
  // Of the material at the plus end, um/s: the mean over the last step; none when that says nothing about the next.
  std::optional<Vec3d> tip_velocity(std::size_t fiber) const;
  ConstVector tension(std::size_t fiber) const { return fibers_[fiber].tension; }  // [n_node] pN, positive: stretched
  // Of the last step; nothing before the first one.
  EndForces const& ends(std::size_t fiber) const { return fibers_[fiber].ends; }
  FiberLoad const& load(std::size_t fiber) const { return fibers_[fiber].load; }
  double elastic_energy() const;  // pN um

  // Everything that an exact restart needs, and back into fibers added in the same order.
  std::vector<NamedArray> state() const;
  void restore(std::span<NamedArray const> state);

 private:
  struct Fiber {
    FiberProperties properties;
    MinusEndSite site;
    Plan plan;
    Centreline past[3];  // at the last accepted times, latest first
    int n_past = 1;
    int n_smooth = 3;  // accepted steps since the tip's force last jumped; 3: or more
    Centreline newborn, predicted, trial;
    PointArray history, extrapolated, sampled;   // [n_node] a1 X_now + a2 X_before; quadratic extrapolation; buffer
    std::vector<double> coordinates;             // [n_node] buffer
    std::vector<double> tension, trial_tension;  // [n_node] pN
    EndForces ends, trial_ends;
    FiberLoad load;
    Vec3d late_force{};  // pN: share of the last step before a jump of the tip's force, times that
    FiberResponse response;
    OwnFlow own_flow;  // of a nonlocal fiber
    double error = 0.0;  // um
  };

  NamedArray stored_ends() const;
  NamedArray stored_loads() const;
  NamedArray stored_late_forces() const;
  void lay_out();
  void add_to_bodies(std::span<Vector6> loads) const;  // fiber_loads_
  void predict(Fiber& fiber, std::span<BodyMotionMap const> bodies) const;
  void set_history(Fiber& fiber, TimeScheme const& scheme) const;
  TimeScheme scheme_of(Fiber const& fiber) const;
  int usable_past(Fiber const& fiber) const;
  static bool has_jumped(Fiber const& fiber);
  void estimate_error(Fiber& fiber) const;

  double viscosity_;
  bool has_nonlocal_ = false;
  double dt_ = 0.0, dt_1_ = 0.0, dt_2_ = 0.0;  // s, this step and the two accepted before it
  std::vector<Fiber> fibers_;
  std::vector<std::size_t> first_node_{0};
  PointArray nodes_;
  std::vector<double> weights_;
  mutable std::vector<Vector6> fiber_loads_;  // [n_fiber] summed in order, whatever the number of threads
};

}  // namespace asterflow

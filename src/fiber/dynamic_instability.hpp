#pragma once
// Dynamic instability of microtubules: plus ends grow at V_g and shrink at V_s, switch by catastrophe (rate f_cat) and
// rescue (f_res), and a fiber that has shrunk to L_min is renucleated as a straight one on its site, growing again.
// [Mitchison & Kirschner 1984; physics of Kimura & Onami 2005] At the cortex a growing plus end turns back or, where
// that is modelled, pushes on (mechanism/pushing.hpp); it may be captured and let go (mechanism/cortical_pulling.hpp).
// An event happens when the integral of its rate since the event before reaches an exponential random number keyed by
// (seed, fiber, number of the event); inside a step, events happen at their exact times. So the history of a fiber that
// does not meet the cortex does not depend on the time step, the number of threads or a restart.

#include "base/named_array.hpp"
#include "fiber/dynamic_instability_spec.hpp"
#include "fiber/fiber_ends.hpp"

#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace asterflow {

class Fibers;

// A rate up to a time after the beginning of the step.
struct CaptureRate {
  double until;  // s
  double rate;   // 1/s
};

// What a plus end meets during a step; rates and factors are means over the step.
struct TipSurroundings {
  double clearance = std::numeric_limits<double>::infinity();  // um, from the tip to the cortex along the fiber
  double approach_speed = 0.0;  // um/s, at which the material of the tip itself moves towards the cortex
  bool can_push = false;        // at the cortex: grows on against it; else turns back
  double pushing_growth_factor = 1.0;     // of the growth speed of a pushing tip, >= 0
  double pushing_catastrophe_rate = 0.0;  // 1/s, of a pushing tip
  std::span<CaptureRate const> capture_rates = {};  // of a growing or pushing tip, in order of time; then none
  double detachment_rate = 0.0;           // 1/s, of a captured tip
  double captured_speed = 0.0;            // um/s, at which a captured fiber lengthens
};

class DynamicInstability {
 public:
  // Plus end of one fiber. Everything that a restart needs, and what happened in the step.
  struct Tip {
    std::size_t fiber = 0;  // its index
    double length = 0.0;    // um
    TipState state = TipState::growing;
    double hazard = 0.0;          // integral of the rate of the next switch since the event before
    double capture_hazard = 0.0;  // the same of the capture rate
    std::uint64_t event = 0;      // events so far

    bool is_newborn = false;  // renucleated
    // Times after the beginning of the step, s: of reaching the cortex to push it, of capture, and of the end of a hold
    // (pushing or captured) that lasted since before.
    std::optional<double> contact_at = {}, captured_at = {}, released_at = {};
    bool is_held() const { return state == TipState::pushing || state == TipState::captured; }
  };

  DynamicInstability(DynamicInstabilitySpec const& spec, std::uint64_t seed) : spec_(spec), seed_(seed) {}

  DynamicInstabilitySpec const& spec() const { return spec_; }

  // Lets a fiber grow and shrink from now on.
  void add(std::size_t fiber, double length);

  // Trial state after dt. `surroundings` [n_tip], in the order of add(); empty: nothing is met.
  void advance(double dt, std::span<TipSurroundings const> surroundings = {});
  // The state of one tip after dt, from the last accepted one; into the trial state.
  Tip advanced(std::size_t tip, double dt, TipSurroundings const& surroundings) const;
  void set_trial(std::size_t tip, Tip const& state) { trial_[tip] = state; }
  // Sets length, renucleation and jumps of the load in the fibers' plan of the step.
  void plan(Fibers& fibers) const;
  void plan(Fibers& fibers, std::size_t tip) const;
  void accept() { now_ = trial_; }

  std::vector<Tip> const& tips() const { return now_; }
  std::vector<Tip> const& trial_tips() const { return trial_; }
  TipState state_of(std::size_t fiber) const;  // at the last accepted time

  // State at the last accepted time, and back; the same fibers must have been added.
  std::vector<NamedArray> state() const;
  void restore(std::span<NamedArray const> state);

 private:
  struct Course;

  Course course(Tip const& tip, TipSurroundings const& surroundings, double capture_rate) const;
  void switch_state(Tip& tip, double time) const;
  void reach_end(Tip& tip, TipSurroundings& surroundings, double time) const;

  DynamicInstabilitySpec spec_;
  std::uint64_t seed_;
  std::vector<Tip> now_, trial_;
  std::vector<int> tip_of_fiber_;  // [largest fiber + 1], -1: none
};

}  // namespace asterflow

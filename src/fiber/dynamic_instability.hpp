#pragma once
// Dynamic instability of microtubules: plus ends grow at V_g and shrink at V_s, switch by catastrophe (rate f_cat) and
// rescue (f_res), and a fiber that has shrunk to L_min is renucleated as a straight one on its site, growing again.
// Reaching the cortex is a catastrophe. [Mitchison & Kirschner 1984; physics of Kimura & Onami 2005]
// An event happens when the integral of its rate since the event before reaches an exponential random number keyed by
// (seed, fiber, number of the event); inside a step, events happen at their exact times. So the history of a fiber that
// does not meet the cortex does not depend on the time step, the number of threads or a restart.

#include "base/named_array.hpp"
#include "fiber/dynamic_instability_spec.hpp"
#include "fiber/fiber_ends.hpp"

#include <limits>
#include <span>
#include <vector>

namespace asterflow {

class Fibers;

// What a growing plus end meets during a step.
struct TipSurroundings {
  double clearance = std::numeric_limits<double>::infinity();  // um, from the tip to the cortex along the fiber
  double approach_speed = 0.0;      // um/s, at which the material of the tip itself moves towards the cortex
  double growth_factor = 1.0;       // of the growth speed, >= 0
  double catastrophe_factor = 1.0;  // of the catastrophe rate, >= 0
};

class DynamicInstability {
 public:
  // Plus end of one fiber. Everything that a restart needs.
  struct Tip {
    std::size_t fiber = 0;  // its index
    double length = 0.0;    // um
    bool is_growing = true;
    double hazard = 0.0;      // integral of the rate of the next event since the event before
    std::uint64_t event = 0;  // events so far
    bool is_newborn = false;  // renucleated during the step
  };

  DynamicInstability(DynamicInstabilitySpec const& spec, std::uint64_t seed) : spec_(spec), seed_(seed) {}

  // Lets a fiber grow and shrink from now on.
  void add(std::size_t fiber, double length);

  // Trial state after dt. `surroundings` [n_tip], in the order of add(); empty: nothing is met.
  void advance(double dt, std::span<TipSurroundings const> surroundings = {});
  // Sets length and renucleation of the trial state in the fibers' plan of the step.
  void plan(Fibers& fibers) const;
  void accept() { now_ = trial_; }

  std::vector<Tip> const& tips() const { return now_; }
  std::vector<Tip> const& trial_tips() const { return trial_; }

  TipState state_of(std::size_t fiber) const;  // at the last accepted time

  // State at the last accepted time, and back; the same fibers must have been added.
  std::vector<NamedArray> state() const;
  void restore(std::span<NamedArray const> state);

 private:
  void advance(Tip& tip, double dt, TipSurroundings surroundings) const;

  DynamicInstabilitySpec spec_;
  std::uint64_t seed_;
  std::vector<Tip> now_, trial_;
  std::vector<int> tip_of_fiber_;  // [largest fiber + 1], -1: none
};

}  // namespace asterflow

#pragma once
// Pushing of the cortex by growing plus ends [paper, A.2.1]. d: distance of the plus end X from the cortex, n: outward
// normal, X_s: tangent. A growing tip makes contact at d = d* (free sliding: 5 d*) and keeps it until its catastrophe.
//   no sliding     F = -K (X - X_att), X_att: where it made contact; along n with at least F_P / d*, so that plus ends
//                  do not pass the cortex
//   friction       the same, but X_att slides along the cortex: zeta dX_att/dt = K (I - n n) (X - X_att)
//   free sliding   F = -F_P exp(-d / d*) (n . X_s) n, zero for a tip that points inwards
//   growth         V_g = V_g0 exp(-F_c / F_P), F_c = max(0, -F . X_s); f_cat = max(f_cat0 V_g0 / V_g, f_min)  [Eq. 7]
// Implicit: the new length and the force on the tip are solved together for each fiber, with the flow and the motion of
// its body extrapolated; the step then takes the force linear about that solution.

#include "base/time_scheme.hpp"
#include "fiber/dynamic_instability.hpp"
#include "mechanism/cortex_surface.hpp"
#include "mechanism/pushing_spec.hpp"

namespace asterflow {

class Pushing {
 public:
  Pushing(PushingSpec const& spec, CortexSurface const& cortex) : spec_(spec), cortex_(cortex) {}

  void add_tip(double spring_stiffness);  // pN/um, in the order of the tips of DynamicInstability

  double contact_distance() const;  // um
  double growth_factor(double compression) const;  // V_g / V_g0 at F_c, pN

  void begin_step() { trial_ = now_; }
  double growth_factor_before(std::size_t tip) const { return growth_factor(now_[tip].compression); }
  // What a tip meets in a step in which it pushes for so long, s, and at whose end its compression is given, pN.
  void surround(std::size_t tip, double rate_without_load, double pushed, double compression,
                TipSurroundings& surroundings) const;
  void surround(std::size_t tip, double rate_without_load, TipSurroundings& surroundings) const;  // as before the step

  // Holds a tip that has made contact in this step; `reached`: where it was then, `left`: of the step after that, s.
  void make_contact(std::size_t tip, Vec3d reached, double left);
  // Force on a tip that pushes at the beginning of the step, pN.
  Vec3d last_force(std::size_t tip) const { return now_[tip].force; }

  // The load on a tip that pushes, linear about its balance, for a tip that would move to `free_position` without it.
  TipLoad load(std::size_t tip, Vec3d free_position, Matrix3 const& compliance, Vec3d tangent, double dt) const;

  // Completes a step: tips that still push have this force (pN), position and tangent at its end.
  void advance(std::size_t tip, bool is_pushing, Vec3d force, Vec3d position, Vec3d tangent, double dt);
  void accept() { now_ = trial_; }
  // Whether a tip there is still in reach of the cortex; springs keep theirs.
  bool is_in_reach(Vec3d position) const;

  std::vector<NamedArray> state() const;
  void restore(std::span<NamedArray const> state);

 private:
  struct Contact {
    bool is_made = false;
    double age = 0.0;                 // s, since contact was made
    double span = 0.0;                // s, between the two anchors; 0: there is one only, where contact was made
    Vec3d anchor{}, anchor_before{};  // um
    Vec3d force{};                    // pN, on the tip
    double compression = 0.0;         // pN
    std::optional<double> sliding_time = {};  // s, of the step, when contact was made in it
  };

  double share_of_end(Contact const& contact, double pushed) const;
  TimeScheme scheme(Contact const& contact, double dt) const;
  TipLoad spring(std::size_t tip, double dt) const;
  TipLoad repulsion(Vec3d free_position, Matrix3 const& compliance, Vec3d tangent) const;

  PushingSpec spec_;
  CortexSurface cortex_;
  std::vector<double> stiffness_;  // [n_tip] pN/um
  std::vector<Contact> now_, trial_;
};

// The force that a load exerts on a tip which it moves from `free_position` by the compliance, pN.
Vec3d balanced_force(TipLoad const& load, Vec3d free_position, Matrix3 const& compliance);

}  // namespace asterflow

#pragma once
// Cytoplasmic pulling [paper, A.2.3]: motors that carry cargo towards the minus end pull the fiber the other way,
//   f_motor = n_dyn F_m X_s   on the fiber, per length,
// and the cargo pushes the fluid with -f_motor where it is. Seen from outside the two cancel, so the other objects feel
// only the elastic part of the fiber's force; the fiber itself drags against f = f_elastic + f_motor.
// A motor slows down under load, F = F_stall (1 - V / V_max), and its cargo moves at V = F / gamma, gamma = 6 pi mu a:
//   F_m = F_stall V_max / (V_max + F_stall / gamma)
// The motion of the fiber itself is neglected against V.
// A cargo that trails at the distance b behind its motor leaves a force dipole, f_motor at X and -f_motor at X + b X_s: others
// then feel, besides the elastic part, the force of tethers under the tension tau along the fiber,
//   f_dipole = d/ds (tau X_s),  tau = n_dyn F_m b,   -tau X_s X_s of stress per length, no net force, no net torque.

#include "base/arrays.hpp"
#include "mechanism/cytoplasmic_pulling_spec.hpp"

namespace asterflow {

class Fibers;

// F_m, pN, in a fluid of that viscosity, pN s/um^2.
double motor_force(CytoplasmicPullingSpec const& spec, double viscosity);

class CytoplasmicPulling {
 public:
  CytoplasmicPulling(CytoplasmicPullingSpec const& spec, double viscosity);

  // Adds the motors of every fiber to the plan of the step.
  void plan(Fibers& fibers) const;

  // force_density [n_node] (pN/um) += f_dipole, on the predicted shapes.
  void add_dipoles(Fibers const& fibers, Points force_density) const;

 private:
  double force_density_;  // n_dyn F_m, pN/um
  double tension_;        // tau, pN
};

// force_density [n_node] (pN/um) of one fiber += d/ds (tension tangents), with the tension's ends as forces there.
//   tangents [n_node] at its nodes; length um; tension pN
void add_tether_tension(double tension, double length, ConstPoints tangents, Points force_density);

}  // namespace asterflow

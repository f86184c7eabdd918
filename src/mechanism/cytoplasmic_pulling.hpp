#pragma once
// Cytoplasmic pulling [paper, A.2.3]: motors that carry cargo towards the minus end pull the fiber the other way,
//   f_motor = n_dyn F_m X_s   on the fiber, per length,
// and the cargo pushes the fluid with -f_motor where it is. Seen from outside the two cancel, so the other objects feel
// only the elastic part of the fiber's force; the fiber itself drags against f = f_elastic + f_motor.
// A motor slows down under load, F = F_stall (1 - V / V_max), and its cargo moves at V = F / gamma, gamma = 6 pi mu a:
//   F_m = F_stall V_max / (V_max + F_stall / gamma)
// The motion of the fiber itself is neglected against V.

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

 private:
  double force_density_;  // n_dyn F_m, pN/um
};

}  // namespace asterflow

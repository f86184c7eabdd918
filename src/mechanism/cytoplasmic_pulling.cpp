#include "mechanism/cytoplasmic_pulling.hpp"

#include "fiber/fibers.hpp"

#include <numbers>

namespace asterflow {

double motor_force(CytoplasmicPullingSpec const& spec, double viscosity) {
  if (spec.motor_force) return *spec.motor_force;
  double const drag = 6 * std::numbers::pi * viscosity * spec.cargo_radius;
  return spec.stall_force * spec.free_speed / (spec.free_speed + spec.stall_force / drag);
}

CytoplasmicPulling::CytoplasmicPulling(CytoplasmicPullingSpec const& spec, double viscosity)
    : force_density_(spec.motor_density * motor_force(spec, viscosity)) {}

void CytoplasmicPulling::plan(Fibers& fibers) const {
  for (std::size_t i = 0; i < fibers.count(); ++i) fibers.plan(i).load.motor += force_density_;
}

}  // namespace asterflow

#include "mechanism/cytoplasmic_pulling.hpp"

#include "base/parallel.hpp"
#include "fiber/fibers.hpp"

#include <array>
#include <numbers>

namespace asterflow {

double motor_force(CytoplasmicPullingSpec const& spec, double viscosity) {
  if (spec.motor_force) return *spec.motor_force;
  double const drag = 6 * std::numbers::pi * viscosity * spec.cargo_radius;
  return spec.stall_force * spec.free_speed / (spec.free_speed + spec.stall_force / drag);
}

CytoplasmicPulling::CytoplasmicPulling(CytoplasmicPullingSpec const& spec, double viscosity)
    : force_density_(spec.motor_density * motor_force(spec, viscosity)), tension_(force_density_ * spec.cargo_offset) {}

void CytoplasmicPulling::plan(Fibers& fibers) const {
  for (std::size_t i = 0; i < fibers.count(); ++i) fibers.plan(i).load.motor += force_density_;
}

// The weak form, sum_j w_j f_j g(X_j) = -sum_i w_i tau X_s . grad g, is without force and torque to rounding: positions are
// polynomials of the basis, and their derivatives are the tangents.
void add_tether_tension(double tension, double length, ConstPoints tangents, Points force_density) {
  FiberBasis const& basis = fiber_basis(static_cast<int>(tangents.size()));
  double const scale = tension / length;
  for (int j = 0; j < basis.n_node; ++j)
    for (int i = 0; i < basis.n_node; ++i) force_density[j] += (scale * basis.weak_derivative(j, i)) * tangents[i];
}

void CytoplasmicPulling::add_dipoles(Fibers const& fibers, Points force_density) const {
  if (tension_ == 0.0) return;
  parallel_for("CytoplasmicPulling::dipoles", static_cast<long>(fibers.count()), [&](long i_fiber) {
    Centreline const& shape = fibers.predicted_shape(i_fiber);
    std::size_t const first = fibers.first_node(i_fiber), n = fibers.first_node(i_fiber + 1) - first;
    FiberBasis const& basis = fiber_basis(static_cast<int>(n));
    std::array<Vec3d, max_fiber_nodes> tangents{};
    for (std::size_t i = 0; i < n; ++i)
      for (int k = 0; k < basis.n_tangent; ++k) tangents[i] += basis.tangent(static_cast<int>(i), k) * shape.tangents[k];
    add_tether_tension(tension_, shape.length, ConstPoints(tangents.data(), n), force_density.subspan(first, n));
  });
}

}  // namespace asterflow

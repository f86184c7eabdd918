#include "io/fluid_spec.hpp"

namespace asterflow {

FluidSpec read_fluid(Table table) {
  FluidSpec fluid;
  table.read("viscosity", fluid.viscosity, positive, "pN s/um^2");
  table.finish();
  return fluid;
}

}  // namespace asterflow

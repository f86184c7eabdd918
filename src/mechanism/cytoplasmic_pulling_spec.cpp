#include "mechanism/cytoplasmic_pulling_spec.hpp"

namespace asterflow {

CytoplasmicPullingSpec read_cytoplasmic_pulling(Table table) {
  CytoplasmicPullingSpec spec;
  table.read("motor_density", spec.motor_density, not_negative, "1/um");
  table.read("motor_force", spec.motor_force, not_negative, "pN");
  table.read("stall_force", spec.stall_force, positive, "pN");
  table.read("free_speed", spec.free_speed, positive, "um/s");
  table.read("cargo_radius", spec.cargo_radius, positive, "um");
  table.read("cargo_offset", spec.cargo_offset, not_negative, "um");
  if (spec.motor_force)
    for (char const* key : {"stall_force", "free_speed", "cargo_radius"})
      if (table.has(key)) table.fail(key, "does not go together with motor_force");
  table.finish();
  return spec;
}

}  // namespace asterflow

#include "mechanism/steric_repulsion_spec.hpp"

namespace asterflow {

StericRepulsionSpec read_steric_repulsion(Table table) {
  StericRepulsionSpec spec;
  table.read("range", spec.range, positive, "um");
  table.read("fiber_force", spec.fiber_force, not_negative, "pN/um");
  table.read("body_force", spec.body_force, not_negative, "pN");
  table.read("exempt_length", spec.exempt_length, not_negative, "um");
  table.read("fiber_cortex", spec.fiber_cortex);
  table.read("fiber_body", spec.fiber_body);
  table.read("body_cortex", spec.body_cortex);
  table.read("body_body", spec.body_body);
  table.finish();
  return spec;
}

}  // namespace asterflow

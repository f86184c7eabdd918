#include "fiber/dynamic_instability_spec.hpp"

namespace asterflow {

DynamicInstabilitySpec read_dynamic_instability(Table table) {
  DynamicInstabilitySpec spec;
  table.read("growth_speed", spec.growth_speed, positive, "um/s");
  table.read("shrinkage_speed", spec.shrinkage_speed, positive, "um/s");
  table.read("catastrophe_rate", spec.catastrophe_rate, not_negative, "1/s");
  table.read("rescue_rate", spec.rescue_rate, not_negative, "1/s");
  table.read("minimal_length", spec.minimal_length, positive, "um");
  table.read("cortex_margin", spec.cortex_margin, not_negative, "um");
  table.read("initially_shrinking", spec.initially_shrinking, between(0.0, 1.0));
  table.finish();
  return spec;
}

double length_decay(DynamicInstabilitySpec const& spec) {
  return spec.catastrophe_rate / spec.growth_speed - spec.rescue_rate / spec.shrinkage_speed;
}

}  // namespace asterflow

#pragma once
// Growth and shrinkage of microtubules as a scene describes them: the table [dynamic_instability], for all fibers and
// asters with growing = true.

#include "base/table.hpp"

namespace asterflow {

struct DynamicInstabilitySpec {
  double growth_speed = 0.5;         // um/s, > 0
  double shrinkage_speed = 0.5;      // um/s, > 0
  double catastrophe_rate = 0.0625;  // 1/s, >= 0, of growing fibers; mean length growth_speed / catastrophe_rate
  double rescue_rate = 0.0;          // 1/s, >= 0, of shrinking fibers
  double minimal_length = 0.5;       // um, > 0; a fiber that shrinks to it is renucleated on its site
  double cortex_margin = 0.1;        // um, >= 0; plus ends meet the cortex so far inside the periphery, so that the
                                     // fluid between them stays resolved
  double initially_shrinking = 0.0;  // fraction of the fibers, 0 to 1, that shrink at time 0
};

DynamicInstabilitySpec read_dynamic_instability(Table table);

// 1/um: k of the lengths exp(-k l) to which this leads, f_cat / V_g - f_res / V_s; negative where most fibers reach the
// cortex.
double length_decay(DynamicInstabilitySpec const& spec);

}  // namespace asterflow

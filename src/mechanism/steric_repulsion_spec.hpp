#pragma once
// Repulsion of what comes close to the cortex or to a body: the table [steric_repulsion].

#include "base/table.hpp"

namespace asterflow {

struct StericRepulsionSpec {
  double range = 0.05;         // d*, um, > 0: closer than this two objects repel
  double fiber_force = 10.0;   // f_0, pN/um, >= 0: per length of fiber in touch
  double body_force = 100.0;   // F_0, pN, >= 0: of a body in touch
  double exempt_length = 0.5;  // um, >= 0: of a fiber from its minus end, where its body does not repel it
  bool fiber_cortex = true;
  bool fiber_body = false;     // fibers and bodies, those that hold them and others
  bool body_cortex = true;
  bool body_body = true;
};

StericRepulsionSpec read_steric_repulsion(Table table);

}  // namespace asterflow

#pragma once
// The fluid: the table [fluid].

#include "base/table.hpp"

namespace asterflow {

struct FluidSpec {
  double viscosity = 1.0;  // pN s/um^2 (= Pa s), > 0
};

FluidSpec read_fluid(Table table);

}  // namespace asterflow

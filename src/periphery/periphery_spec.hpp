#pragma once
// The fixed no-slip surface that encloses a confined scene, centred at the origin: the table [periphery].

#include "surface/shape_spec.hpp"

namespace asterflow {

struct PeripherySpec {
  ShapeSpec shape;  // shape, radius, semi_axes, profile
  int order = 0;    // spectral order of the surface, 4 to 96; 0: from the accuracy of the run
};

PeripherySpec read_periphery(Table table);

}  // namespace asterflow

#pragma once
// Motors that walk along the fibers and pull cargo through the cytoplasm: the table [cytoplasmic_pulling].

#include "base/table.hpp"

#include <optional>

namespace asterflow {

struct CytoplasmicPullingSpec {
  double motor_density = 0.1;         // n_dyn, 1/um, >= 0: motors per length of fiber
  std::optional<double> motor_force = {};  // F_m, pN, >= 0; not given: from the motor and its cargo
  double stall_force = 1.1;           // F_stall, pN, > 0
  double free_speed = 2.0;            // V_max, um/s, > 0: of a motor without load
  double cargo_radius = 0.25;         // um, > 0: of a sphere with Stokes drag
  double cargo_offset = 0.0;          // b, um, >= 0: its centre trails so far behind the motor, along the fiber
};

CytoplasmicPullingSpec read_cytoplasmic_pulling(Table table);

}  // namespace asterflow

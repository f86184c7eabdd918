#pragma once
// Growing plus ends that push the cortex: the table [pushing].

#include "base/table.hpp"

#include <optional>

namespace asterflow {

struct PushingSpec {
  enum class Sliding { none, free, friction };

  Sliding sliding = Sliding::none;        // of the plus end along the cortex
  double stall_force = 4.4;               // F_P, pN, > 0: growth slows by e for each; also scales free sliding's force
  double range = 0.02;                    // d*, um, > 0: contact begins (free: the force decays) within it
  double minimal_catastrophe_rate = 0.2;  // f_min, 1/s, >= 0, at the cortex
  std::optional<double> spring_stiffness = {}; // K, pN/um, > 0, unless sliding is free; not given: 100 E / (body radius)^2
  double friction = 0.0;                  // zeta, pN s/um, > 0, only with sliding = "friction"
};

PushingSpec read_pushing(Table table);

}  // namespace asterflow

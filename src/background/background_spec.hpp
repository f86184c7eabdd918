#pragma once
// An imposed flow in unbounded fluid, u(x) = velocity + gradient x: the table [background].

#include "base/table.hpp"

namespace asterflow {

struct BackgroundSpec {
  Vec3d velocity;            // um/s, uniform part
  Table::Matrix gradient{};  // 1/s, row i column j is du_i/dx_j; trace 0. Keys: gradient = 3 rows, or
                             // shear_rate = G for u = G y e_x
};

BackgroundSpec read_background(Table table);

}  // namespace asterflow

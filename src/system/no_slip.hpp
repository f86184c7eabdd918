#pragma once
// How well a flow meets no slip between the nodes of the surfaces, where nothing enforces it: the largest
// |u(x) - u_wall(x)| over points x in the middle of the nodes' cells, u_wall = 0 on the periphery and U + Omega x r on
// a body. It holds what the surfaces' nodes do not resolve of the flow that meets them, and the error of the solve.

#include "system/stored_flow.hpp"

namespace asterflow {

struct NoSlipResidual {
  double periphery = 0.0;  // um/s
  double bodies = 0.0;     // um/s
  double speed = 0.0;      // um/s, largest of the flow that meets a surface and of the bodies' surfaces
  bool is_at_rest() const { return speed < 1e-12; }  // um/s: rounding alone
  double relative() const;  // the larger residual over that speed; 0 at rest
};

// A few hundred points on each surface.
NoSlipResidual no_slip_residual(StoredFlow const& flow);

}  // namespace asterflow

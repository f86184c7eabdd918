#pragma once
// The torque instability of cortical pushing [paper, A.3 and Figure 10]: straight fibers reach from the asters of a body
// to the periphery; there is no fluid, no growth and no bending. The push on a plus end depends on the length L alone,
//   F1 = -lambda E L^-2 n   along the outward normal n of the periphery: free sliding
//   F2 = -lambda E L^-2 p   along the fiber, p its direction: no sliding
// and turns the body, whose rotational drag is that of a sphere of its radius a, with
//   Omega / Omega_0 = (a / N) sum_i e_z . (r_i x F_i) / (lambda E),   Omega_0 = lambda E N / (8 pi mu a^4),
// r_i from the body's centre to the plus end of fiber i of N. alpha is the angle about z from the x axis (AP) to the
// axis of the first aster (intercentrosomal axis): d alpha / dt = Omega.

#include "io/scene.hpp"

#include <vector>

namespace asterflow {

struct TurningRates {
  double free_sliding = 0.0, no_sliding = 0.0;  // Omega / Omega_0 for F1, F2
};

struct TorquePoint {
  double angle = 0.0;      // alpha, degrees
  TurningRates continuum;  // of ever more fibers, uniform over the openings of the asters: by quadrature
  TurningRates fibers;     // of the fibers of the scene
};

// The body named in [drag], or the only one, at its place in the scene and turned to each angle (degrees).
std::vector<TorquePoint> torque_instability(Scene const& scene, std::vector<double> const& angles);

}  // namespace asterflow

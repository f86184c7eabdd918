#pragma once
// Resistance of rigid bodies in Stokes flow, in open fluid or inside a fixed periphery:
//   (F_1, T_1, F_2, ...) = R (U_1, Omega_1, U_2, ...),
// forces and torques of the bodies on the fluid, torques about the bodies' own positions; R is symmetric and positive
// definite, the mobility is its inverse. Boundary integral equation with completed double layers (double_layer.hpp) on
// all surfaces; a surface with a close neighbour crowds its nodes at the contact (close_spots.hpp). The order follows from
// the gaps and the accuracy, and rises until the estimated error meets the accuracy.
// [Power & Miranda 1987; Kim & Karrila 1991, ch. 15]

#include "surface/contact.hpp"

#include <Eigen/Core>
#include <optional>

namespace asterflow {

struct ResistanceOptions {
  double viscosity = 1.0;  // pN s / um^2
  double accuracy = 1e-6;  // relative; selects the order and the tolerances
  int order = 0;           // of every surface's grid; 0: from accuracy and gaps
};

struct Resistance {
  Eigen::MatrixXd resistance;  // 6n x 6n: pN s/um, pN s, pN um s
  Eigen::MatrixXd mobility;    // its inverse
  double error = 0.0;          // estimated, relative: from the change with the order and from R - R^T
  int order = 0;               // of all surfaces
  int iterations = 0;          // of GMRES, largest over the motions
};

// Throws SceneError where surfaces overlap; NumericalError where a gap is below 1e-4 of the smaller surface's size, or
// where the error exceeds 1 %. Above the accuracy asked for, `error` says so.
Resistance solve_resistance(std::vector<PlacedSurface> const& bodies, std::optional<PlacedSurface> const& periphery,
                            ResistanceOptions const& options);

}  // namespace asterflow

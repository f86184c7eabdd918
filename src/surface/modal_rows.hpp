#pragma once
// Double layer of an axisymmetric surface, one azimuthal mode at a time:
//   u_i(x) = -3/(4 pi) int r_i r_j r_k / r^5 q_j n_k dS,  r = x - y, n outward  (constant q: u = q inside, q/2 on, 0 outside).
// Cylindrical components about the polar axis e_1: (axial, radial, azimuthal). For a density
//   (q_a, q_r, q_phi) = (q1, q2, i q3) e^{i m phi}  the velocity is  (u1, u2, i u3) e^{i m phi}  with real rows u = row_m q.
// Between rings q is interpolated by a polynomial in cos t, times sin t where the parity of a smooth field wants it
// (axial: odd m; radial and azimuthal: even m). The integral is a tensor product of graded rules about the closest point,
// accurate at any distance; what remains of its error is removed for the part that is constant near the closest point.

#include "surface/surface.hpp"

#include <Eigen/Core>

namespace asterflow {

struct CylindricalPoint {
  double z, r;  // um, from the origin of the shape's frame: along e_1 of the surface's grading, and away from that axis
};

// rows[m]: 3 x 3 n_ring, columns: q1 of all rings, q2 of all rings, q3 of all rings. m = 0 ... p.
using ModalRowSet = std::vector<Eigen::Matrix<double, 3, Eigen::Dynamic>>;

class ModalRows {
 public:
  // digits: of the quadrature. Keeps a reference to the surface.
  ModalRows(Surface const& surface, double digits);

  // Target off the surface. inside: on which side.
  ModalRowSet at(CylindricalPoint target) const;
  // Target on the surface at grid angle t: the principal value (average of both limits).
  ModalRowSet on_surface(double t) const;

 private:
  struct Singularity {
    double t, distance, jump;  // closest point, um, u for a unit constant density
  };
  ModalRowSet integrate(CylindricalPoint target, Singularity const& near) const;
  void remove_constant_defect(Singularity const& near, ModalRowSet& rows) const;
  void interpolation_values(double t, double* even, double* odd) const;  // cardinal functions of all rings

  Surface const& surface_;
  int n_mode_, n_ring_;
  double digits_;
  std::vector<double> sin_t_;      // [n_ring]
  Eigen::MatrixXd nodes_to_legendre_;  // n_ring x n_ring: coefficient of P_l from ring values
};

}  // namespace asterflow

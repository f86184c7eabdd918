#pragma once
// Double layer of any surface as rows over its nodes, one target at a time (kernel and signs: modal_rows.hpp).
// Between nodes the density is a trigonometric polynomial in phi and a polynomial in cos t, times sin t for odd modes.
// The integral is a tensor product of graded rules: in t about the closest point, in phi, for every t, about the closest
// point of that ring. What remains of its error is removed for the part that is constant near the closest point.

#include "surface/surface.hpp"

#include <Eigen/Core>

namespace asterflow {

// u = rows * q with q of all nodes, x0 y0 z0 x1 ...: 3 x 3 size.
using NodeRows = Eigen::Matrix<double, 3, Eigen::Dynamic>;

class GeneralRows {
 public:
  GeneralRows(Surface const& surface, double digits);  // keeps a reference to the surface

  NodeRows at(Vec3d target) const;             // off the surface
  NodeRows on_surface(std::size_t node) const; // principal value

 private:
  struct Singularity {
    double t, phi, distance, jump;  // closest point, um, u for a unit constant density
  };
  struct Ring;
  void integrate_ring(Vec3d target, Grading::PolarAngle angle, double weight, Ring& ring,
                      Eigen::Ref<Eigen::MatrixXd> result) const;
  NodeRows integrate(Vec3d target, Singularity const& near) const;
  double closest_azimuth(Vec3d target, Grading::PolarAngle ring, double guess) const;
  Eigen::VectorXd cardinal_functions(double t, double phi) const;  // of all nodes at a point
  // Entries of the symmetric kernel in mode space, [t rules, 6 (2 p + 1)], to ring values of every mode, to nodes.
  NodeRows to_nodes(std::vector<double> const& t, Eigen::MatrixXd const& modal) const;
  void ring_polynomials(std::vector<double> const& t, Eigen::MatrixXd& even, Eigen::MatrixXd& odd) const;

  Surface const& surface_;
  int order_, n_ring_;
  double digits_;
  Eigen::MatrixXd nodes_to_legendre_;  // n_ring x n_ring
  Eigen::MatrixXd modes_to_nodes_;     // (2 p + 1) x (2 p + 2): 1, cos phi ... cos p phi, sin phi ... sin p phi
};

}  // namespace asterflow

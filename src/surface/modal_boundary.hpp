#pragma once
// Boundary integral equation of the Stokes-Dirichlet problem inside or outside an axisymmetric surface, one azimuthal
// mode at a time. The unknown is a double-layer density q,
//   interior  (1/2 + D) q + n int q.n dS / area = w               (the flux, one-dimensional null space, is completed)
//   exterior (-1/2 + D) q + Stokeslet(F) + rotlet(T) = w,  F = -2/l int q dS, T = -2/l int (y - centre) x q dS,
// l^2 = area / (4 pi)  [Power & Miranda 1987]. F and T are force and torque on the fluid, viscosity 1.
// Components as in modal_rows.hpp: (axial, radial, azimuthal / i).

#include "surface/azimuth_transform.hpp"
#include "surface/modal_rows.hpp"
#include "surface/shell_operator.hpp"

namespace asterflow {

// Velocity at (z, r) from the centre of a unit force and a unit torque there (columns), viscosity 1: along e_1 (mode 0),
// or along (e_2 + i e_3) and (e_3 - i e_2) (mode 1).
Eigen::Matrix<double, 3, 2> modal_velocity_of_load(int mode, CylindricalPoint x);

// Fourier coefficients of one mode on the rings, real and imaginary part. Rows: component * n_ring + ring.
using RingMode = Eigen::Matrix<double, Eigen::Dynamic, 2>;
// Node values -> modes 0 ... p. transform: of n_azimuth values.
std::vector<RingMode> analyse_modes(Surface const& surface, AzimuthTransform const& transform, ConstPoints field);
// And back; adds to the node values.
void add_synthesis(Surface const& surface, AzimuthTransform const& transform, std::vector<RingMode> const& modes,
                   Points field);

class ModalBoundary {
 public:
  ModalBoundary(Surface const& surface, Side side, double digits);  // keeps a reference to the surface

  using Mode = RingMode;
  using LoadRows = Eigen::Matrix<double, 2, Eigen::Dynamic>;  // force, torque

  Surface const& surface() const { return surface_; }
  Side side() const { return side_; }
  ModalRows const& rows() const { return rows_; }
  int n_mode() const { return surface_.grid().n_mode(); }
  int n_ring() const { return surface_.grid().n_ring(); }

  std::vector<Mode> analyse(ConstPoints field) const { return analyse_modes(surface_, transform_, field); }
  void synthesise(std::vector<Mode> const& modes, Points field) const;   // overwrites
  Eigen::MatrixXd const& equation(int mode) const { return equations_[mode]; }
  LoadRows load_of_density(int mode) const;                              // modes 0 (axial) and 1 (transverse)
  // Force and torque about the centre along (e_1, e_2, e_3), from their two modes.
  static Eigen::Matrix<double, 6, 1> load(Eigen::Matrix2d const& axial, Eigen::Matrix2d const& transverse);
  CylindricalPoint ring(int j) const;                                    // from the shape's centre

 private:
  Eigen::MatrixXd assemble(int mode, std::vector<ModalRowSet> const& rings) const;

  Surface const& surface_;
  Side side_;
  ModalRows rows_;
  AzimuthTransform transform_;
  std::vector<Eigen::MatrixXd> equations_;  // [mode] (3 n_ring) x (3 n_ring)
};

}  // namespace asterflow

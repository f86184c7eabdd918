#pragma once
// A vector field around a closed surface, tabulated on scaled copies ("shells") of it and interpolated anywhere.
// Coordinates (psi, theta, phi): theta, phi of the surface's parametrisation; the shell's scale is
//   interior  rho = (1 + cos psi) / 2,   exterior  1 / rho = (1 + cos psi) / 2,   psi in [0, pi],
// so psi = 0 is the surface and psi = pi the centre or infinity. In all three the field continues as a periodic function.
// Components are cylindrical about the polar axis: (axial, radial, azimuthal).

#include "base/arrays.hpp"
#include "surface/azimuth_transform.hpp"
#include "surface/interpolation_window.hpp"
#include "surface/sphere_grid.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <vector>

namespace asterflow {

// Fourier coefficients of one azimuthal mode m (azimuth_transform.hpp) on all shells and rings: real and imaginary part.
// Rows: (i_shell * 3 + component) * n_ring + i_ring. The azimuthal component is divided by i. Shells that are left out
// at the end hold nothing of this mode.
template <class Real>
using ShellMode = Eigen::Matrix<Real, Eigen::Dynamic, 2>;

// Position of a target, for the tables of any resolution, and its frame.
struct TablePoint {
  double psi, theta, phi;  // over pi, pi, 2 pi: each in [0, 1]
  double cos_phi, sin_phi;
};

// Between which shells targets lie: psi over pi. Without targets it is empty, first > last.
struct PsiRange {
  double first = 1.0, last = 0.0;
  void add(double psi) { first = std::min(first, psi), last = std::max(last, psi); }
};

// Scale of shell k: (1 + cos psi_k) / 2, psi_k = pi k / (n_shell - 1).
double shell_scale(int k, int n_shell);

class ShellTable {
 public:
  // oversampling: cells of the table over those that resolve the field, in each direction.
  ShellTable(SphereGrid const& grid, int n_shell, int window_width, double oversampling);

  int n_shell() const { return n_shell_; }
  // psi over pi; components of the direction along (e_1, e_2, e_3), any length
  static TablePoint locate(double psi, Vec3d direction);

  // Numbers of type Real: double or float.
  template <class Real>
  struct Values {
    std::vector<Real> velocity;                    // [psi, theta, phi, component]
    std::vector<Eigen::MatrixX<Real>> meridian;    // work space: [mode] [theta, (part, component, psi)]
    std::size_t memory() const { return sizeof(Real) * velocity.capacity(); }  // bytes
  };
  // Overwrites what targets within `range` read.
  template <class Real>
  void fill(std::vector<ShellMode<Real>> const& modes, PsiRange range, Values<Real>& values) const;
  // Components along (e_1, e_2, e_3).
  template <class Real>
  void interpolate(Values<Real> const& values, TablePoint const& point, double velocity[3]) const;
  std::size_t memory() const;  // bytes of one set of doubles

  // The adjoint of interpolation: on every coefficient of the modes,
  //   sum_j weight of the coefficient at point j x (f_axial, f_radial, -i f_azimuthal) e^{-i m phi_j};
  // forces have components along (e_1, e_2, e_3). The modes have rows for as many shells as are wanted; overwrites.
  struct Collection {  // work space
    struct Force {
      long first[3];
      double psi[16], theta[16], phi[48];  // weights; those of phi times (axial, radial, azimuthal)
    };
    std::vector<Force> forces;
    std::vector<std::vector<std::size_t>> starting;  // [psi] forces whose first node this is
    std::vector<Eigen::MatrixXd> meridian;           // [mode] [theta, (part, component, psi)]
  };
  void collect(std::vector<TablePoint> const& points, ConstPoints forces, std::vector<ShellMode<double>>& modes,
               Collection& work) const;

 private:
  struct Rows {  // of the table, along psi
    long first, count;
  };
  Rows rows_of(PsiRange range) const;
  template <class Real>
  void fill_meridian(int m, ShellMode<Real> const& mode, Rows rows, Eigen::MatrixX<Real>& fine) const;
  template <class Real>
  void fill_azimuth(long i_psi, Values<Real>& values) const;
  void weigh_forces(std::vector<TablePoint> const& points, ConstPoints forces, Collection& work) const;
  void collect_azimuth(long i_psi, Collection& work) const;
  void collect_meridian(int m, Eigen::MatrixXd const& fine, ShellMode<double>& mode) const;
  template <int width, class Real>
  void interpolate_with(Values<Real> const& values, TablePoint const& point, double velocity[3]) const;

  int n_ring_, n_mode_, n_shell_;
  InterpolationWindow window_;
  int n_psi_, n_theta_, n_phi_;         // cells along [0, pi], [0, pi], [0, 2 pi)
  int margin_, row_;                    // ghost nodes on each side; nodes of a circle of phi with its ghosts
  template <class Real>
  struct Upsampling {
    Eigen::MatrixX<Real> psi;       // [n_psi + 1 + 2 margin, n_shell]
    Eigen::MatrixX<Real> theta[2];  // [n_theta + 1 + 2 margin, n_ring], even and odd in theta
  };
  template <class Real>
  Upsampling<Real> const& up() const;
  Upsampling<double> up_;
  Upsampling<float> rough_up_;
  std::vector<double> phi_correction_;  // [n_mode]
  AzimuthTransform transform_;
};

}  // namespace asterflow

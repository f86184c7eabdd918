#pragma once
// Velocity of point forces close to an axisymmetric wall, together with their images behind it (image_wall.hpp), on that
// wall, projected onto the functions that its nodes resolve:
//   w = P sum_j K(., y_j) f_j,   K Stokeslet and image for viscosity 1.
// What the image leaves of a force at the distance d is largest on a spot of the size d. Where the nodes are farther apart,
// samples at the nodes mistake the spot for something else all over the wall. The projection leaves out what the nodes
// cannot hold and keeps the rest: it is right wherever the spot's details are no longer felt.
// P K(., y) is a smooth function of y up to the wall. So it is tabulated in the place of the force, as the solution is in the
// target, with the adjoint of interpolation (shell_table.hpp): foot of the force on the wall and distance,
//   distance = deepest reach (1 - cos psi) / 2,   deepest, reach: image_wall.hpp.
// P keeps the spherical harmonics of degree <= p of the Cartesian components, as functions of the direction d of X(d).

#include "surface/azimuth_transform.hpp"
#include "surface/graded_rule.hpp"
#include "surface/image_wall.hpp"
#include "surface/shell_table.hpp"

namespace asterflow {

class ScreenedForces {
 public:
  // wall: of a cell.
  ScreenedForces(ImageWall const& wall, double accuracy);

  // Of a force with images at the distance from the point of the wall that has that direction.
  TablePoint locate(Vec3d direction, double distance_over_reach) const;

  // velocity [n_node] += w of forces (pN over viscosity). Calls on one object must not overlap: they share work arrays.
  void add_velocity(std::vector<TablePoint> const& points, ConstPoints forces, Points velocity) const;
  std::size_t memory() const;  // bytes

 private:
  struct Place;
  using ModalColumns = std::vector<Eigen::Matrix<double, Eigen::Dynamic, 3>>;  // [mode] (3 n_ring) x 3
  using RingVelocities = Eigen::Matrix<double, Eigen::Dynamic, 9>;             // [point, 3 component of force + x y z]
  Place place(int ring, int shell) const;
  void ring_velocities(Place const& place, Vec3d ring, double digits, std::vector<RulePoint>& azimuth,
                       RingVelocities& u) const;
  ModalColumns project(Place const& place, double digits) const;
  void assemble(double accuracy);

  ImageWall wall_;
  Surface const& surface_;
  int n_ring_, n_mode_;
  SphereGrid places_;  // feet of forces
  ShellTable table_;
  AzimuthTransform transform_;
  std::vector<Eigen::MatrixXd> basis_at_rings_;  // [order m] [n_ring, l]
  std::vector<Eigen::MatrixXd> matrices_;        // [mode] (3 n_ring) x (kept shells * 3 feet)
  mutable std::vector<ShellMode<double>> collected_, modes_;
  mutable ShellTable::Collection work_;
};

}  // namespace asterflow

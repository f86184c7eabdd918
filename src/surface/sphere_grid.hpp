#pragma once
// Gauss-Legendre x trapezoid grid of order p on the unit sphere: p + 1 rings, or more, at polar angles theta_j, where
// cos theta_j are Gauss-Legendre nodes, each of 2 p + 2 equispaced azimuths phi_k. Integrates spherical harmonics up to
// degree 2 p + 1 exactly. Node (j, k) has index j (2 p + 2) + k. theta ascends from the pole theta = 0.

#include <cstddef>
#include <vector>

namespace asterflow {

class SphereGrid {
 public:
  SphereGrid(int order) : SphereGrid(order, order + 1) {}  // order >= 1; implicit: an order stands for its grid
  SphereGrid(int order, int n_ring);                       // n_ring > order

  int order() const { return order_; }
  int n_ring() const { return static_cast<int>(theta_.size()); }
  int n_mode() const { return order_ + 1; }  // azimuthal ones that it holds: 0 ... p
  int n_azimuth() const { return 2 * order_ + 2; }
  std::size_t size() const { return static_cast<std::size_t>(n_ring()) * n_azimuth(); }

  std::vector<double> const& polar_angles() const { return theta_; }     // [n_ring]
  std::vector<double> const& ring_weights() const { return weights_; }   // [n_ring], for d(cos theta); sum 2
  double azimuth(int k) const;                                           // 2 pi k / n_azimuth

 private:
  int order_;
  std::vector<double> theta_, weights_;
};

}  // namespace asterflow

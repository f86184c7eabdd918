#pragma once
// The window with which strengths are spread onto a patch's grid and velocities interpolated from it: a Kaiser-
// Bessel window of `width` nodes, evaluated as one polynomial per node [Barnett, Magland & af Klinteberg 2019].

#include "backends/fast_patch.hpp"

#include <vector>

namespace asterflow {

template <class Real>
class GridWindow {
 public:
  // sums_in_double: see WindowView.
  GridWindow(int width, double shape, bool sums_in_double);

  int width() const { return width_; }
  int padded_width() const { return padded_; }  // 8, 12 or 16: one row of the window as vectors
  double transform(double theta) const;         // of the window at wave number theta per node
  double largest_weight(int j) const;           // of the node `j` after the first
  WindowView<Real> view() const { return {width_, padded_, degree_, coefficients_.data(), sums_in_double_}; }

  // What the inner loops need to know of a patch; lanes: numbers in a vector register.
  PatchView<Real> view(Patch<Real> const& patch, int lanes) const;

  // The first node that a point's window meets in direction d, from 0 to the period.
  static int first_node(PatchView<Real> const& patch, Vec3d const& point, int d);

  // The nodes that the windows of the points in a box meet; in a direction in which one goes beyond the period all of them.
  void find_reach(Patch<Real> const& patch, PointBox const& box, int (&low)[3], int (&high)[3]) const;

  // Sorts the points of the given ranges into the tiles of the patch.
  TiledPoints tile(Patch<Real> const& patch, PointArray const& points, std::vector<Range> const& ranges) const;

 private:
  void sort_by_column(Patch<Real> const& patch, PointArray const& points, TiledPoints& tiled) const;

  int width_, padded_, degree_;
  double shape_;
  bool sums_in_double_;
  std::vector<Real> coefficients_;  // [2, degree + 1, padded]: of the weights, of their slopes per node
};

extern template class GridWindow<float>;
extern template class GridWindow<double>;

}  // namespace asterflow

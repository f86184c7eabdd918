#pragma once
// Spreading of point strengths onto a patch's grid and interpolation from it, with a Kaiser-Bessel window of
// `width` nodes, evaluated as one polynomial per node [Barnett, Magland & af Klinteberg 2019].
// Grid layout: [z, y, component, x], x padded by ghost nodes that continue the period.

#include "backends/fast_patch.hpp"

#include <vector>

namespace asterflow {

template <class Real>
class GridWindow {
 public:
  GridWindow(int width, double shape);

  int width() const { return width_; }
  int padded_width() const { return padded_; }  // 8, 12 or 16: one row of the window as vectors
  double transform(double theta) const;         // of the window at wave number theta per node

  // Nodes of one row of the grid of `patch`, ghosts and padding included.
  long row(Patch<Real> const& patch) const;

  // First of the `width` nodes around coordinate xi (in nodes), and the distance that fixes the weights.
  int first_node(double xi) const;

  // Sorts the points of the given ranges into the tiles of the patch.
  TiledPoints tile(Patch<Real> const& patch, PointArray const& points, std::vector<Range> const& ranges) const;

  // Overwrites the nodes of one tile with the sum over all sources; strengths [n, components].
  void spread(Patch<Real> const& patch, long i_tile, PointArray const& points, Real const* strengths, int components,
              Real* grid) const;

  // velocity [n] += patch.scale * interpolated first 3 components at the targets of one tile.
  void interpolate(Patch<Real> const& patch, long i_tile, PointArray const& points, Real const* grid, int components,
                   Vec3d* velocity) const;

 private:
  template <int padded, int components>
  void spread_rows(Patch<Real> const& patch, long i_tile, PointArray const& points, Real const* strengths,
                   Real* grid) const;
  template <int components>
  void spread_components(Patch<Real> const& patch, long i_tile, PointArray const& points, Real const* strengths,
                         Real* grid) const;
  template <int padded>
  void interpolate_rows(Patch<Real> const& patch, long i_tile, PointArray const& points, Real const* grid,
                        int components, Vec3d* velocity) const;
  template <int padded>
  void weights(Vec3d const& xi, int const (&first)[3], void* rows) const;

  int width_, padded_, degree_;
  double shape_;
  std::vector<Real> coefficients_;  // [degree + 1, padded]
};

extern template class GridWindow<float>;
extern template class GridWindow<double>;

}  // namespace asterflow

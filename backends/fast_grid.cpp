#include "backends/fast_grid.hpp"

#include "backends/fast_window.hpp"

#include <algorithm>
#include <cmath>

namespace asterflow {
namespace {

// Monomial coefficients in z = 2 s - 1 of the window over the interval j - width / 2 + s, 0 <= s <= 1, by Chebyshev
// interpolation.
std::vector<double> interval_polynomial(KaiserBessel const& window, int width, int j, int n) {
  std::vector<double> series(n, 0.0), before(n, 0.0), now(n, 0.0), next(n, 0.0), sum(n, 0.0);
  for (int k = 0; k < n; ++k)
    for (int i = 0; i < n; ++i) {
      double const z = std::cos(M_PI * (i + 0.5) / n);
      double const x = (j - 0.5 * width + 0.5 * (z + 1.0)) * 2.0 / width;
      series[k] += (k == 0 ? 1.0 : 2.0) / n * window.value(x) * std::cos(M_PI * k * (i + 0.5) / n);
    }
  now[0] = 1.0;
  for (int k = 0; k < n; ++k) {
    for (int i = 0; i < n; ++i) {
      sum[i] += series[k] * now[i];
      next[i] = (k == 0 ? 1.0 : 2.0) * (i > 0 ? now[i - 1] : 0.0) - (k == 0 ? 0.0 : before[i]);
    }
    before = now;
    now = next;
  }
  return sum;
}

// A number of its own for every column of a tile; the window begins at node x of the period and row y of the tile.
std::uint64_t column_of(int x, int y, int width) {
  constexpr int group = PointColumn::rows_at_once;
  int const more = (y % group + width - 1) / group > (width - 1) / group;  // groups that the window meets: one more, or not
  return static_cast<std::uint64_t>(2 * (y / group) + more) << 16 | static_cast<std::uint64_t>(x / (PointColumn::nodes + 1 - width));
}

int wrapped(int i, int n) { return i < 0 ? i + n : i >= n ? i - n : i; }

}  // namespace

template <class Real>
GridWindow<Real>::GridWindow(int width, double shape, bool sums_in_double)
    : width_(width),
      padded_(width <= 8 ? 8 : width <= 12 ? 12 : 16),
      degree_(width + 1),
      shape_(shape),
      sums_in_double_(sums_in_double) {
  KaiserBessel const window(shape);
  std::size_t const n = degree_ + 1;
  coefficients_.assign(2 * n * padded_, Real(0));
  for (int j = 0; j < width; ++j) {
    auto const polynomial = interval_polynomial(window, width, j, static_cast<int>(n));
    for (std::size_t k = 0; k < n; ++k) coefficients_[k * padded_ + j] = static_cast<Real>(polynomial[k]);
    // A point that moves by one node changes z by -2.
    for (std::size_t k = 1; k < n; ++k)
      coefficients_[(n + k - 1) * padded_ + j] = static_cast<Real>(-2.0 * static_cast<double>(k) * polynomial[k]);
  }
}

template <class Real>
double GridWindow<Real>::transform(double theta) const {
  return 0.5 * width_ * KaiserBessel(shape_).spectrum(0.5 * width_ * theta);
}

template <class Real>
double GridWindow<Real>::largest_weight(int j) const {
  double const from = j - 0.5 * width_;  // of the middle, where the window is largest, to from + 1
  return KaiserBessel(shape_).value((from >= 0.0 ? from : from + 1.0 <= 0.0 ? from + 1.0 : 0.0) * 2.0 / width_);
}

template <class Real>
int GridWindow<Real>::first_node(PatchView<Real> const& patch, Vec3d const& point, int d) {
  return wrapped(static_cast<int>(std::floor((point[d] - patch.corner[d]) * patch.to_nodes)), patch.nodes[d]);
}

template <class Real>
PatchView<Real> GridWindow<Real>::view(Patch<Real> const& patch, int lanes) const {
  PatchView<Real> view;
  for (int d = 0; d < 3; ++d) {
    view.nodes[d] = patch.nodes[d];
    view.corner[d] = patch.corner[d] + patch.unit_side * (patch.origin[d] + (0.5 * width_ - 1.0) * patch.spacing);
    view.target_low[d] = patch.target_low[d];
    view.target_high[d] = patch.target_high[d];
    view.source_low[d] = patch.source_low[d];
    view.source_high[d] = patch.source_high[d];
    view.used_low[d] = patch.used_low(d);
    view.used_high[d] = patch.used_high(d);
    view.lines[d] = patch.lines[d];
    view.modes[d] = patch.symbol ? patch.symbol->modes[d] : 0;
  }
  view.to_nodes = 1.0 / (patch.unit_side * patch.spacing);
  view.slope_scale = patch.scale / patch.spacing;
  view.scale = patch.scale;
  view.tile_y = patch.tile_y, view.tile_z = patch.tile_z;
  view.tiles_y = patch.tiles_y, view.tiles_z = patch.tiles_z;
  view.velocity_row = (patch.target_high[0] - patch.target_low[0] + padded_ + lanes - 1) / lanes * lanes;
  constexpr long line = 64 / static_cast<long>(sizeof(Real));  // of the cache: an odd number of them, as in a tile
  if (view.velocity_row / line % 2 == 0) view.velocity_row += std::max<long>(lanes, line);
  view.spectrum_row = (view.used_high[1] - view.used_low[1] + lanes - 1) / lanes * lanes;
  view.planes = view.used_high[2] - view.used_low[2];
  view.crowding = patch.crowding.empty() ? nullptr : patch.crowding.data();
  view.sources = {patch.sources.index.data(), patch.sources.tile_begin.data(), patch.sources.column.empty() ? nullptr : patch.sources.column.data()};
  view.targets = {patch.targets.index.data(), patch.targets.tile_begin.data(), patch.targets.column.empty() ? nullptr : patch.targets.column.data()};
  view.symbol_stride = patch.symbol ? patch.symbol->stride : 0;
  view.band = patch.symbol ? patch.symbol->band : 0.0;
  view.symbol = patch.symbol ? patch.symbol->value.data() : nullptr;
  return view;
}

template <class Real>
void GridWindow<Real>::find_reach(Patch<Real> const& patch, PointBox const& box, int (&low)[3], int (&high)[3]) const {
  PatchView<Real> const grid = view(patch, 1);
  for (int d = 0; d < 3; ++d) {
    low[d] = high[d] = 0;
    if (box.is_empty()) continue;
    auto const first = [&](double x) { return static_cast<int>(std::floor((x - grid.corner[d]) * grid.to_nodes)); };
    low[d] = first(box.low[d]);
    high[d] = first(box.high[d]) + width_;
    if (low[d] < 0 || high[d] > patch.nodes[d]) low[d] = 0, high[d] = patch.nodes[d];
  }
}

template <class Real>
TiledPoints GridWindow<Real>::tile(Patch<Real> const& patch, PointArray const& points,
                                   std::vector<Range> const& ranges) const {
  PatchView<Real> const grid = view(patch, 1);
  TiledPoints tiled;
  tiled.tile_begin.assign(patch.n_tile() + 1, 0);
  long n = 0;
  for (Range const& range : ranges) n += range.size();
  auto const tile_of = [&](Vec3d const& x, int d, int size, int n_tile) {
    return std::min((first_node(grid, x, d) - grid.used_low[d]) / size, n_tile - 1);
  };
  std::vector<int> tiles;
  tiles.reserve(n);
  for (Range const& range : ranges)
    for (long i = range.begin; i < range.end; ++i) {
      tiles.push_back(tile_of(points[i], 2, patch.tile_z, patch.tiles_z) * patch.tiles_y +
                      tile_of(points[i], 1, patch.tile_y, patch.tiles_y));
      ++tiled.tile_begin[tiles.back() + 1];
    }
  for (long i = 0; i < patch.n_tile(); ++i) tiled.tile_begin[i + 1] += tiled.tile_begin[i];
  std::vector<long> next(tiled.tile_begin.begin(), tiled.tile_begin.end() - 1);
  tiled.index.resize(n);
  long k = 0;
  for (Range const& range : ranges)
    for (long i = range.begin; i < range.end; ++i, ++k) tiled.index[next[tiles[k]]++] = static_cast<std::uint32_t>(i);
  if (sizeof(Real) == sizeof(double)) sort_by_column(patch, points, tiled);
  return tiled;
}

template <class Real>
void GridWindow<Real>::sort_by_column(Patch<Real> const& patch, PointArray const& points, TiledPoints& tiled) const {
  PatchView<Real> const grid = view(patch, 1);
  tiled.column.resize(tiled.index.size());
  std::vector<std::uint64_t> keys;  // column, first node along z, index
  for (long tile = 0; tile < patch.n_tile(); ++tile) {
    auto const [y_begin, y_end, z_begin, z_end] = patch.tile_nodes(tile);
    long const begin = tiled.tile_begin[tile], end = tiled.tile_begin[tile + 1];
    keys.clear();
    for (long k = begin; k < end; ++k) {
      Vec3d const& point = points[tiled.index[k]];
      std::uint64_t const column = column_of(first_node(grid, point, 0), first_node(grid, point, 1) - y_begin, width_);
      auto const z = static_cast<std::uint64_t>(first_node(grid, point, 2) - z_begin);
      keys.push_back((column << 8 | z) << 32 | tiled.index[k]);
    }
    std::sort(keys.begin(), keys.end());
    for (long k = begin; k < end; ++k) {
      tiled.index[k] = static_cast<std::uint32_t>(keys[k - begin]);
      tiled.column[k] = static_cast<std::uint32_t>(keys[k - begin] >> 40);
    }
  }
}

template class GridWindow<float>;
template class GridWindow<double>;

}  // namespace asterflow

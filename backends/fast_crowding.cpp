#include "backends/fast_crowding.hpp"

#include "base/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace asterflow {
namespace {

// Cells of two nodes along one direction, from the first node that sources reach.
struct Cells {
  int low, n;
  bool is_periodic;

  template <class Real>
  Cells(Patch<Real> const& patch, int d)
      : low(patch.source_low[d]),
        n((patch.source_high[d] - low + 1) / 2),
        is_periodic(patch.source_high[d] - low == patch.nodes[d]) {}

  int of(int node) const { return (node - low) / 2; }
};

// Bounds of the weights that a point of one cell gives to the nodes of the same cell and those after it.
template <class Real>
std::vector<float> largest_weights(GridWindow<Real> const& window) {
  std::vector<float> taps;
  for (int k = 0; 2 * k - 1 < window.width(); ++k) {
    double largest = 0.0;
    for (int j = std::max(0, 2 * k - 1); j <= std::min(2 * k + 1, window.width() - 1); ++j) largest = std::max(largest, window.largest_weight(j));
    taps.push_back(static_cast<float>(largest));
  }
  return taps;
}

// Counts [outer, n, inner] of cells; sums over the taps along the middle direction.
std::vector<float> spread_along(std::vector<float> const& count, Cells const& cells, long outer, long inner,
                                std::vector<float> const& taps) {
  std::vector<float> sum(count.size(), 0.0f);
  parallel_for("Fast::crowding", outer, [&](long o) {
    for (int i = 0; i < cells.n; ++i)
      for (int k = 0; k < static_cast<int>(taps.size()); ++k) {
        int const to = i + k < cells.n ? i + k : cells.is_periodic ? (i + k) % cells.n : -1;
        if (to < 0) break;
        float const* const from = count.data() + (o * cells.n + i) * inner;
        float* const row = sum.data() + (o * cells.n + to) * inner;
        for (long x = 0; x < inner; ++x) row[x] += taps[k] * from[x];
      }
  });
  return sum;
}

// The first and one past the last cell of a tile's nodes begin ... end - 1.
std::pair<int, int> cell_range(Cells const& cells, int begin, int end) {
  int const first = std::max(begin, cells.low), last = std::min(end - 1, cells.low + 2 * cells.n - 1);
  if (first > last) return {0, 0};
  return {cells.of(first), cells.of(last) + 1};
}

}  // namespace

template <class Real>
std::vector<float> crowding(GridWindow<Real> const& window, Patch<Real> const& patch, PointArray const& points,
                            std::vector<Range> const& ranges) {
  std::vector<float> largest(patch.n_tile(), 0.0f);
  PatchView<Real> const grid = window.view(patch, 1);
  Cells const cells[3] = {{patch, 0}, {patch, 1}, {patch, 2}};
  long const nx = cells[0].n, ny = cells[1].n, nz = cells[2].n;
  std::vector<float> sums(nx * ny * nz, 0.0f);
  for (Range const& range : ranges)
    for (long i = range.begin; i < range.end; ++i) {
      int at[3];
      for (int d = 0; d < 3; ++d) at[d] = cells[d].of(window.first_node(grid, points[i], d));
      sums[(at[2] * ny + at[1]) * nx + at[0]] += 1.0f;
    }
  auto const taps = largest_weights(window);
  sums = spread_along(sums, cells[0], ny * nz, 1, taps);
  sums = spread_along(sums, cells[1], nz, nx, taps);
  sums = spread_along(sums, cells[2], 1, nx * ny, taps);
  parallel_for("Fast::crowding", patch.n_tile(), [&](long tile) {
    auto const [y_begin, y_end, z_begin, z_end] = patch.tile_nodes(tile);
    auto const y = cell_range(cells[1], y_begin, y_end), z = cell_range(cells[2], z_begin, z_end);
    for (long k = z.first; k < z.second; ++k)
      for (long j = y.first; j < y.second; ++j)
        for (long x = 0; x < nx; ++x) largest[tile] = std::max(largest[tile], sums[(k * ny + j) * nx + x]);
  });
  return largest;
}

template std::vector<float> crowding(GridWindow<float> const&, Patch<float> const&, PointArray const&, std::vector<Range> const&);
template std::vector<float> crowding(GridWindow<double> const&, Patch<double> const&, PointArray const&, std::vector<Range> const&);

}  // namespace asterflow

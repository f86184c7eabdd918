#pragma once
// One rectangular piece of one level: a periodic grid on which the sources near the patch act on the targets
// inside it through that level's band-limited kernel. Lengths are in units of the root's side; places of points in those
// of the tree's points.

#include "backends/fast_fourier.hpp"
#include "backends/fast_tree.hpp"

#include <array>
#include <limits>
#include <memory>
#include <vector>

namespace asterflow {

// Bounding box of the points of some ranges.
struct PointBox {
  static constexpr double infinite = std::numeric_limits<double>::infinity();
  Vec3d low{infinite, infinite, infinite}, high{-infinite, -infinite, -infinite};

  PointBox() = default;
  PointBox(PointArray const& points, std::vector<Range> const& ranges) {
    for (Range const& range : ranges)
      for (long i = range.begin; i < range.end; ++i)
        for (int d = 0; d < 3; ++d) {
          low[d] = points[i][d] < low[d] ? points[i][d] : low[d];
          high[d] = points[i][d] > high[d] ? points[i][d] : high[d];
        }
  }
  bool is_empty() const { return low.x > high.x; }
};

// Points of a patch sorted by the grid tile that holds their first node. Within a tile, where `column` is not empty, by
// column (see fast_loops.hpp) and first node along z.
struct TiledPoints {
  std::vector<std::uint32_t> index;   // in the order of the tree
  std::vector<long> tile_begin;       // [n_tile + 1]
  std::vector<std::uint32_t> column;  // of each of them
};

// Multipliers of the Fourier modes, per octant of wave numbers [jx, |jy|, |jz|]; zero outside the band.
template <class Real>
struct SymbolTable {
  int modes[3] = {0, 0, 0};   // largest wave number kept in each direction
  int stride = 0;             // of |jz|, rounded up to whole vectors
  double band = 0.0;          // |k| kept, in units of 1 / grid spacing
  std::vector<Real> value;
};

template <class Real>
struct Patch {
  int nodes[3] = {0, 0, 0};          // of the periodic grid
  Vec3d origin;                      // position of node (0, 0, 0)
  double spacing = 1.0;
  double scale = 1.0;                // from grid units of velocity to normalised ones
  Vec3d corner;                      // of the root's cube, and its
  double unit_side = 1.0;            // side, as the points have them
  int target_low[3] = {0, 0, 0};     // nodes from which targets are interpolated
  int target_high[3] = {0, 0, 0};    // one past the last
  int source_low[3] = {0, 0, 0};     // nodes that sources are spread onto; all where a window goes beyond the period
  int source_high[3] = {0, 0, 0};
  int tile_y = 16, tile_z = 16;      // nodes of a tile; the last in a direction takes the rest too
  int tiles_y = 1, tiles_z = 1;
  TiledPoints sources, targets;
  std::vector<float> crowding;       // of each tile, see fast_crowding.hpp; empty unless strengths add up with care
  std::shared_ptr<SymbolTable<Real> const> symbol;
  LineView<Real> lines[3];

  // Nodes of sources or targets.
  int used_low(int d) const { return source_low[d] < target_low[d] ? source_low[d] : target_low[d]; }
  int used_high(int d) const { return source_high[d] > target_high[d] ? source_high[d] : target_high[d]; }

  // Of the used nodes. A window of `width` nodes may begin in one tile and end in the next; small tiles stay in the cache.
  void set_tiles(int edge_y, int width) {
    tile_y = edge_y;
    tile_z = width < 8 ? 8 : width;
    int const n_y = used_high(1) - used_low(1), n_z = used_high(2) - used_low(2);
    tiles_y = n_y < tile_y ? 1 : n_y / tile_y;
    tiles_z = n_z < tile_z ? 1 : n_z / tile_z;
  }
  // y_begin, y_end, z_begin, z_end of one of them.
  std::array<int, 4> tile_nodes(long tile) const {
    int const y = static_cast<int>(tile % tiles_y), z = static_cast<int>(tile / tiles_y);
    int const y_begin = used_low(1) + y * tile_y, z_begin = used_low(2) + z * tile_z;
    return {y_begin, y + 1 == tiles_y ? used_high(1) : y_begin + tile_y, z_begin,
            z + 1 == tiles_z ? used_high(2) : z_begin + tile_z};
  }
  long n_tile() const { return static_cast<long>(tiles_y) * tiles_z; }
  long n_node() const { return static_cast<long>(nodes[0]) * nodes[1] * nodes[2]; }
};

}  // namespace asterflow

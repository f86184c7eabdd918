// Spreading of many points at a time. Of a column of points (fast_loops.hpp) those whose windows meet a plane z add to its rows
// the product of two matrices, (weights along y times strengths) x (weights along x times those at z). A few rows stay in
// registers while all of these points are added: memory is read and written once for them, not once for each.

namespace asterflow {
namespace {

// Up to `most` points of a column.
template <class Real, int components>
struct ColumnChunk {
  static constexpr int most = 64, fewest_at_once = components > 3 ? 3 : 5;  // points of a chunk; that meet a plane, in the mean
  static constexpr int nodes = PointColumn::nodes, rows_at_once = PointColumn::rows_at_once;
  // Weights along x from node x_first on; along y times strengths from row y_first on; along z. Rows of weights are padded with
  // zeros that may reach into the place of the next point.
  alignas(64) Real x[(most + 1) * nodes], y[(most * components + 1) * nodes], z[(most + 1) * nodes];
  int z_first[most];
  int n = 0, x_first = 0, y_first = 0, n_row = 0;  // n_row: a multiple of rows_at_once

  // Of points at these places, with first nodes counted from the tile's row and the first node of its memory.
  template <int padded>
  void set(WindowView<Real> const& window, GridPlace<Real> const* places, std::uint32_t const* index, int n_point,
           int y_group, Real const* strengths) {
    n = n_point;
    x_first = places[0].first[0];
    int y_last = places[0].first[1];
    for (int i = 0; i < n; ++i) {
      x_first = smaller(x_first, places[i].first[0]);
      y_last = places[i].first[1] > y_last ? places[i].first[1] : y_last;
    }
    y_first = y_group;
    n_row = (y_last - y_first + window.width + rows_at_once - 1) / rows_at_once * rows_at_once;
    for (int i = 0; i < n; ++i) {
      Row<Real, padded> w[3];
      weights<Real, padded>(window.coefficients, window.degree, places[i].z, w);
      z_first[i] = places[i].first[2];
      Row<Real, nodes>::zero().to(x + i * nodes);
      w[0].to(x + i * nodes + places[i].first[0] - x_first);
      Real* const by_y = y + i * components * nodes;
      Real const* const f = strengths + components * static_cast<long>(index[i]);
      for (int c = 0; c < components; ++c) {
        Row<Real, nodes>::zero().to(by_y + c * nodes);
        w[1].scaled(f[c]).to(by_y + c * nodes + places[i].first[1] - y_first);
      }
      w[2].to(z + i * nodes);
    }
  }
};

// Adds points begin ... end - 1 to nodes of plane z: components c ... c + n_component - 1 of the rows first_row ... first_row + n_row - 1, of
// which the first component begins at row[0 ... n_row - 1].
template <class Real, int components, int n_row, int n_component>
inline void add_points(ColumnChunk<Real, components> const& chunk, int begin, int end, int plane, int first_row, int c,
                       Real* const* row, long stride) {
  using P = Pack<Real>;
  constexpr int nodes = PointColumn::nodes, n_vector = nodes / lanes<Real>;
  P sum[n_row][n_component][n_vector];
  for (int r = 0; r < n_row; ++r)
    for (int k = 0; k < n_component; ++k)
      for (int v = 0; v < n_vector; ++v) sum[r][k][v] = P{};
  for (int i = begin; i < end; ++i) {
    Real const weight = chunk.z[i * nodes + plane - chunk.z_first[i]];
    P x[n_vector];
    for (int v = 0; v < n_vector; ++v) x[v] = load(chunk.x + i * nodes + v * lanes<Real>) * weight;
    Real const* const y = chunk.y + (i * components + c) * nodes + first_row;
    for (int r = 0; r < n_row; ++r)
      for (int k = 0; k < n_component; ++k)
        for (int v = 0; v < n_vector; ++v) sum[r][k][v] += x[v] * y[k * nodes + r];
  }
  for (int r = 0; r < n_row; ++r)
    for (int k = 0; k < n_component; ++k)
      for (int v = 0; v < n_vector; ++v) {
        Real* const p = row[r] + (c + k) * stride + v * lanes<Real>;
        store(p, load(p) + sum[r][k][v]);
      }
}

// Adds a chunk to the tile. outside: memory for a row of which nothing is wanted.
template <class Real, int components>
void add_chunk(ColumnChunk<Real, components> const& chunk, int width, TileGrid<Real, Real> const& tile, Real* outside) {
  constexpr int rows_at_once = PointColumn::rows_at_once, most_rows = 16 + rows_at_once;
  constexpr int n_row = pack_bytes == 64 ? 4 : 1;
  int const ny = tile.y_end - tile.y_begin;
  int const first_plane = chunk.z_first[0] > tile.z_begin ? chunk.z_first[0] : tile.z_begin;
  int const last_plane = smaller(chunk.z_first[chunk.n - 1] + width, tile.z_end);
  int begin = 0, end = 0;
  for (int z = first_plane; z < last_plane; ++z) {
    while (end < chunk.n && chunk.z_first[end] <= z) ++end;
    while (begin < end && chunk.z_first[begin] + width <= z) ++begin;
    if (begin == end) continue;
    Real* const plane = tile.grid + static_cast<long>(z - tile.z_begin) * ny * components * tile.stride + chunk.x_first;
    Real* row[most_rows];
    bool is_inside[most_rows];
    for (int r = 0; r < chunk.n_row; ++r) {
      int const y = chunk.y_first + r - tile.y_begin;
      is_inside[r] = y >= 0 && y < ny;
      row[r] = is_inside[r] ? plane + static_cast<long>(y) * components * tile.stride : outside;
    }
    for (int r = 0; r < chunk.n_row; r += n_row) {
      bool is_needed = false;
      for (int k = 0; k < n_row; ++k) is_needed |= is_inside[r + k];
      if (!is_needed) continue;
      for (int c = 0; c < components; c += 3)
        add_points<Real, components, n_row, 3>(chunk, begin, end, z, r, c, row + r, tile.stride);
    }
  }
}

// Spreads the sources of a tile and of those before it, in y and z, whose windows meet the tile. Where a patch is periodic the last
// tile comes before the first one.
template <class Real, int padded, int components>
void spread_columns(WindowView<Real> const& window, PatchView<Real> const& patch, TileGrid<Real, Real> const& tile,
                    double const* points, Real const* strengths, Real* outside) {
  std::memset(tile.grid, 0, sizeof(Real) * components * tile.stride * (tile.y_end - tile.y_begin) * (tile.z_end - tile.z_begin));
  bool const wraps_y = patch.used_high[1] - patch.used_low[1] == patch.nodes[1];
  bool const wraps_z = patch.used_high[2] - patch.used_low[2] == patch.nodes[2];
  using Chunk = ColumnChunk<Real, components>;
  Chunk chunk;
  GridPlace<Real> places[Chunk::most];
  std::uint32_t index[Chunk::most];
  TileView const& sources = patch.sources;
  for (int dy = 1; dy >= 0; --dy) {
    if (tile.y < dy && !wraps_y) continue;
    int const from_y = wrapped(tile.y - dy, patch.tiles_y);
    int const shift_y = tile.y < dy ? patch.nodes[1] : 0, shift_z = tile.z < 1 ? patch.nodes[2] : 0;
    int const tile_begin = patch.used_low[1] + from_y * patch.tile_y;
    long const before = static_cast<long>(wrapped(tile.z - 1, patch.tiles_z)) * patch.tiles_y + from_y;
    long const own = static_cast<long>(tile.z) * patch.tiles_y + from_y;
    // Sources of the tile before in z, if there is one, and then of this one.
    long next[2] = {sources.begin[before], sources.begin[own]}, last[2] = {sources.begin[before + 1], sources.begin[own + 1]};
    if (tile.z < 1 && !wraps_z) next[0] = last[0];
    int n = 0, y_group = 0;
    auto const flush = [&] {
      if (n == 0) return;
      int const z_reach = places[n - 1].first[2] - places[0].first[2] + window.width;
      if (n * window.width < Chunk::fewest_at_once * z_reach) {
        for (int i = 0; i < n; ++i)
          spread_point<Real, Real, padded, components>(window, patch, tile, points + 3L * index[i], strengths + static_cast<long>(components) * index[i]);
        n = 0;
        return;
      }
      chunk.template set<padded>(window, places, index, n, y_group, strengths);
      add_chunk<Real, components>(chunk, window.width, tile, outside);
      n = 0;
    };
    while (next[0] < last[0] || next[1] < last[1]) {
      std::uint32_t column = next[0] < last[0] ? sources.column[next[0]] : sources.column[next[1]];
      if (next[1] < last[1] && sources.column[next[1]] < column) column = sources.column[next[1]];
      bool is_near = true;
      for (int part = 0; part < 2; ++part)
        for (long& k = next[part]; k < last[part] && sources.column[k] == column; ++k) {
          if (!is_near) continue;
          GridPlace<Real> place(patch, points + 3 * static_cast<long>(sources.index[k]));
          place.first[0] = wrapped(place.first[0], patch.nodes[0]) - patch.source_low[0];
          place.first[1] = wrapped(place.first[1], patch.nodes[1]);
          place.first[2] = wrapped(place.first[2], patch.nodes[2]) - (part == 0 ? shift_z : 0);
          y_group = tile_begin + (place.first[1] - tile_begin) / PointColumn::rows_at_once * PointColumn::rows_at_once - shift_y;
          place.first[1] -= shift_y;
          is_near = y_group < tile.y_end && y_group + PointColumn::rows_at_once - 1 + window.width > tile.y_begin;
          if (!is_near || place.first[2] + window.width <= tile.z_begin) continue;
          if (n == Chunk::most) flush();
          index[n] = sources.index[k];
          places[n++] = place;
        }
      flush();
    }
  }
}

// Velocities at up to `most` targets of a column: planes one after the other, each of which stays in the cache while all targets whose
// windows meet it are served.
template <class Real, int padded>
struct TargetChunk {
  static constexpr int most = 64;
  using R = Row<Real, padded>;
  R x[most], sum[most][3];
  alignas(64) Real y[most][padded], z[most][padded];
  int first[most][3];
  std::uint32_t index[most];
  int n = 0;

  void push(WindowView<Real> const& window, GridPlace<Real> const& place, std::uint32_t i) {
    R w[3];
    weights<Real, padded>(window.coefficients, window.degree, place.z, w);
    x[n] = w[0];
    w[1].to(y[n]);
    w[2].to(z[n]);
    for (int d = 0; d < 3; ++d) first[n][d] = place.first[d];
    for (R& s : sum[n]) s = R::zero();
    index[n++] = i;
  }
  // corner: node 0 of the period in all directions.
  void gather(int width, Real const* corner, long row, long stride_z) {
    int begin = 0, end = 0;
    for (int plane = first[0][2]; plane < first[n - 1][2] + width; ++plane) {
      while (end < n && first[end][2] <= plane) ++end;
      while (begin < end && first[begin][2] + width <= plane) ++begin;
      for (int i = begin; i < end; ++i) {
        Real const* const p = corner + plane * stride_z + first[i][1] * 3L * row + first[i][0];
        R part[3] = {R::zero(), R::zero(), R::zero()};
        for (int j = 0; j < width; ++j)
          for (int c = 0; c < 3; ++c) part[c].add_product(R::from(p + (j * 3 + c) * row), y[i][j]);
        Real const weight = z[i][plane - first[i][2]];
        for (int c = 0; c < 3; ++c) sum[i][c].add_product(part[c], weight);
      }
    }
  }
};

template <class Real, int padded>
void interpolate_columns(WindowView<Real> const& window, PatchView<Real> const& patch, long tile, double const* points,
                         Real const* grid, double* velocity) {
  long const row = patch.velocity_row, stride_z = (patch.target_high[1] - patch.target_low[1]) * 3 * row;
  Real const* const corner = grid - patch.target_low[2] * stride_z - patch.target_low[1] * 3 * row - patch.target_low[0];
  TargetChunk<Real, padded> chunk;
  for (long k = patch.targets.begin[tile]; k < patch.targets.begin[tile + 1];) {
    chunk.n = 0;
    std::uint32_t const column = patch.targets.column[k];
    for (; chunk.n < chunk.most && k < patch.targets.begin[tile + 1] && patch.targets.column[k] == column; ++k) {
      std::uint32_t const i = patch.targets.index[k];
      chunk.push(window, GridPlace<Real>(patch, points + 3L * i), i);
    }
    chunk.gather(window.width, corner, row, stride_z);
    for (int i = 0; i < chunk.n; ++i)
      for (int c = 0; c < 3; ++c) velocity[3L * chunk.index[i] + c] += patch.scale * chunk.sum[i][c].dot(chunk.x[i]);
  }
}

template <class Real, class Sum, int padded, int components>
void spread_rows_or_columns(WindowView<Real> const& window, PatchView<Real> const& patch, TileGrid<Real, Sum> const& tile,
                            double const* points, Real const* strengths) {
  constexpr bool pays = pack_bytes == 64 || (pack_bytes == 32 && padded > 8);
  if constexpr (pays && std::is_same_v<Real, double>)
    if (patch.sources.column) {
      long const n = static_cast<long>(components) * tile.stride * (tile.y_end - tile.y_begin) * (tile.z_end - tile.z_begin);
      return spread_columns<Real, padded, components>(window, patch, tile, points, strengths, tile.grid + n);
    }
  spread_rows<Real, Sum, padded, components>(window, patch, tile, points, strengths);
}

template <class Real, class Sum, int components>
void spread(WindowView<Real> const& window, PatchView<Real> const& patch, TileGrid<Real, Sum> const& tile,
            double const* points, Real const* strengths) {
  if (window.padded == 8) return spread_rows_or_columns<Real, Sum, 8, components>(window, patch, tile, points, strengths);
  if (window.padded == 12) return spread_rows_or_columns<Real, Sum, 12, components>(window, patch, tile, points, strengths);
  spread_rows_or_columns<Real, Sum, 16, components>(window, patch, tile, points, strengths);
}

template <class Real>
void interpolate(WindowView<Real> const& window, PatchView<Real> const& patch, long tile, double const* points,
                 Real const* grid, double* velocity, double* gradient) {
  bool const in_columns = patch.targets.column && !gradient;
  if (window.padded == 8) return interpolate_rows<Real, 8>(window, patch, tile, points, grid, velocity, gradient);
  if (window.padded == 12 && in_columns) return interpolate_columns<Real, 12>(window, patch, tile, points, grid, velocity);
  if (window.padded == 12) return interpolate_rows<Real, 12>(window, patch, tile, points, grid, velocity, gradient);
  if (in_columns) return interpolate_columns<Real, 16>(window, patch, tile, points, grid, velocity);
  interpolate_rows<Real, 16>(window, patch, tile, points, grid, velocity, gradient);
}

}  // namespace
}  // namespace asterflow

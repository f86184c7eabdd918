// Spreading of strengths onto the tiles of a patch's grid, and interpolation from the grid of velocities. The
// weights of a point are one polynomial per node [Barnett, Magland & af Klinteberg 2019].

#include <type_traits>

namespace asterflow {
namespace {

// n numbers as vectors of the widest size that divides them.
template <class Real, int n>
struct Row {
  static constexpr int bytes = n * static_cast<int>(sizeof(Real));
  static constexpr int vector_bytes = bytes % pack_bytes == 0 ? pack_bytes : bytes % 32 == 0 && pack_bytes >= 32 ? 32 : 16;
  static constexpr int n_vector = bytes / vector_bytes;
  static constexpr int n_lane = n / n_vector;
  typedef Real V __attribute__((vector_size(vector_bytes)));
  typedef Real Unaligned __attribute__((vector_size(vector_bytes), aligned(sizeof(Real)), may_alias));
  V v[n_vector];

  static Row from(Real const* p) {
    Row row;
    for (int i = 0; i < n_vector; ++i) row.v[i] = reinterpret_cast<Unaligned const*>(p)[i];
    return row;
  }
  template <class Other>
  static Row from(Other const* p) {
    Real numbers[n];
    for (int i = 0; i < n; ++i) numbers[i] = static_cast<Real>(p[i]);
    return from(numbers);
  }
  void to(Real* p) const {
    for (int i = 0; i < n_vector; ++i) reinterpret_cast<Unaligned*>(p)[i] = v[i];
  }
  static Row zero() {
    Row row;
    for (V& part : row.v) part = V{};
    return row;
  }
  // this + a * s
  void add_product(Row const& a, Real s) {
    for (int i = 0; i < n_vector; ++i) v[i] += a.v[i] * s;
  }
  Row scaled(Real s) const {
    Row row;
    for (int i = 0; i < n_vector; ++i) row.v[i] = v[i] * s;
    return row;
  }
  Real dot(Row const& a) const {
    V sum = v[0] * a.v[0];
    for (int i = 1; i < n_vector; ++i) sum += v[i] * a.v[i];
    Real total = 0;
    for (int i = 0; i < n_lane; ++i) total += sum[i];
    return total;
  }
};

inline int wrapped(int i, int n) { return i < 0 ? i + n : i >= n ? i - n : i; }

// Whether nodes first ... first + width - 1, continued periodically, meet begin ... end - 1.
inline bool overlaps(int first, int width, int begin, int end, int n) {
  return (first < end && first + width > begin) || first + width - n > begin;
}

// Where one point lies on the grid: its first node in each direction and the distance that fixes the weights.
template <class Real>
struct GridPlace {
  int first[3];
  Real z[3];

  GridPlace() = default;
  GridPlace(PatchView<Real> const& patch, double const* point) {
    for (int d = 0; d < 3; ++d) {
      double const xi = (point[d] - patch.corner[d]) * patch.to_nodes;
      first[d] = static_cast<int>(std::floor(xi));
      z[d] = static_cast<Real>(2.0 * (first[d] - xi) + 1.0);
    }
  }
};

// The three rows of weights of one point; one loop, so that their chains of operations overlap.
template <class Real, int padded>
void weights(Real const* coefficients, int degree, Real const (&z)[3], Row<Real, padded> (&sum)[3]) {
  using R = Row<Real, padded>;
  Real const* c = coefficients + degree * padded;
  R x = R::from(c), y = x, w = x;
  for (int k = degree - 1; k >= 0; --k) {
    c -= padded;
    R const next = R::from(c);
    R nx = next, ny = next, nw = next;
    nx.add_product(x, z[0]);
    ny.add_product(y, z[1]);
    nw.add_product(w, z[2]);
    x = nx, y = ny, w = nw;
  }
  sum[0] = x, sum[1] = y, sum[2] = w;
}

// Nodes of one row of a tile, from the first that sources reach; ghosts that continue the period and padding included.
template <class Real>
long tile_row(PatchView<Real> const& patch, int padded) {
  if (patch.sources.column) padded = PointColumn::nodes;
  return (patch.source_high[0] - patch.source_low[0] + padded + lanes<Real> - 1) / lanes<Real> * lanes<Real>;
}

// From row to row: an odd number of cache lines, or the rows that a point meets would share a few sets of the cache.
template <class Sum>
long tile_stride(long row) {
  constexpr long line = 64 / static_cast<long>(sizeof(Sum));
  return row / line % 2 ? row : row + line;
}

// The nodes of one tile: y_begin ... y_end - 1, z_begin ... z_end - 1; its rows begin at `grid`, [z, y, component, x].
// `Sum` is the type in which strengths add up: in float small shares of many strengths of one sign would be lost. Whole
// numbers lose nothing, where the largest sum is known: shares are multiples of `unit`.
template <class Real, class Sum>
struct TileGrid {
  int y, z;  // place of the tile
  int y_begin, y_end, z_begin, z_end;
  long row, stride;  // numbers of a row, and from one to the next
  Sum* grid;
  Real unit = 1, units = 1;  // of shares, and how many make 1

  TileGrid(PatchView<Real> const& patch, long tile, int padded, Sum* memory)
      : y(static_cast<int>(tile % patch.tiles_y)), z(static_cast<int>(tile / patch.tiles_y)), grid(memory) {
    y_begin = patch.used_low[1] + y * patch.tile_y;
    y_end = y + 1 == patch.tiles_y ? patch.used_high[1] : y_begin + patch.tile_y;
    z_begin = patch.used_low[2] + z * patch.tile_z;
    z_end = z + 1 == patch.tiles_z ? patch.used_high[2] : z_begin + patch.tile_z;
    row = tile_row(patch, padded);
    stride = tile_stride<Sum>(row);
  }
};

// body(i) for every source i whose window may meet a tile: those of the tile and of the ones before it.
template <class Real, class Body>
void for_sources(PatchView<Real> const& patch, int tile_y, int tile_z, Body const& body) {
  bool const wraps_y = patch.used_high[1] - patch.used_low[1] == patch.nodes[1];
  bool const wraps_z = patch.used_high[2] - patch.used_low[2] == patch.nodes[2];
  for (int dz = 0; dz < smaller(2, patch.tiles_z); ++dz)
    for (int dy = 0; dy < smaller(2, patch.tiles_y); ++dy) {
      if ((tile_y < dy && !wraps_y) || (tile_z < dz && !wraps_z)) continue;
      int const from = wrapped(tile_z - dz, patch.tiles_z) * patch.tiles_y + wrapped(tile_y - dy, patch.tiles_y);
      for (long k = patch.sources.begin[from]; k < patch.sources.begin[from + 1]; ++k) body(patch.sources.index[k]);
    }
}

// Adds the shares load * weight to the nodes of a row from p on.
template <class Share, int padded>
void add_shares(Row<Share, padded> const& load, Share weight, Share* p) {
  Row<Share, padded> sum = Row<Share, padded>::from(p);
  sum.add_product(load, weight);
  sum.to(p);
}
template <int padded>
void add_shares(Row<float, padded> const& load, float weight, std::int32_t* p) {
  auto sum = Row<std::int32_t, padded>::from(p);
  for (int i = 0; i < sum.n_vector; ++i) sum.v[i] += nearest(load.v[i] * weight);
  sum.to(p);
}

// Adds the point's strengths f to the nodes of the tile within its window.
template <class Real, class Sum, int padded, int components>
void spread_point(WindowView<Real> const& window, PatchView<Real> const& patch, TileGrid<Real, Sum> const& tile,
                  double const* point, Real const* f) {
  using Share = std::conditional_t<std::is_integral_v<Sum>, Real, Sum>;
  using R = Row<Share, padded>;
  GridPlace<Real> const place(patch, point);
  int const y0 = wrapped(place.first[1], patch.nodes[1]), z0 = wrapped(place.first[2], patch.nodes[2]);
  if (!overlaps(y0, window.width, tile.y_begin, tile.y_end, patch.nodes[1])) return;
  if (!overlaps(z0, window.width, tile.z_begin, tile.z_end, patch.nodes[2])) return;
  Row<Real, padded> w[3];
  weights<Real, padded>(window.coefficients, window.degree, place.z, w);
  Real wx[padded], wy[padded], wz[padded];
  w[0].to(wx);
  w[1].to(wy);
  w[2].to(wz);
  R const weight_x = R::from(wx);
  long const stride_y = components * tile.stride, stride_z = (tile.y_end - tile.y_begin) * stride_y;
  long offset_y[padded];
  Share weight_y[padded], in_units[components];
  for (int c = 0; c < components; ++c) in_units[c] = f[c] * tile.units;
  int n_y = 0;
  for (int j = 0; j < window.width; ++j) {
    int const y = wrapped(y0 + j, patch.nodes[1]);
    if (y < tile.y_begin || y >= tile.y_end) continue;
    offset_y[n_y] = (y - tile.y_begin) * stride_y;
    weight_y[n_y++] = wy[j];
  }
  for (int j = 0; j < window.width; ++j) {
    int const z = wrapped(z0 + j, patch.nodes[2]);
    if (z < tile.z_begin || z >= tile.z_end) continue;
    R load_x[components];
    for (int c = 0; c < components; ++c) load_x[c] = weight_x.scaled(static_cast<Share>(wz[j]) * in_units[c]);
    Sum* const plane = tile.grid + (z - tile.z_begin) * stride_z + wrapped(place.first[0], patch.nodes[0]) - patch.source_low[0];
    for (int m = 0; m < n_y; ++m) {
      Sum* p = plane + offset_y[m];
      for (int c = 0; c < components; ++c, p += tile.stride) add_shares(load_x[c], weight_y[m], p);
    }
  }
}

template <class Real, class Sum, int padded, int components>
void spread_rows(WindowView<Real> const& window, PatchView<Real> const& patch, TileGrid<Real, Sum> const& tile,
                 double const* points, Real const* strengths) {
  std::memset(tile.grid, 0, sizeof(Sum) * components * tile.stride * (tile.y_end - tile.y_begin) * (tile.z_end - tile.z_begin));
  for_sources(patch, tile.y, tile.z, [&](long i) {
    spread_point<Real, Sum, padded, components>(window, patch, tile, points + 3 * i, strengths + components * i);
  });
}

// Sums of the three velocity components, weighted along y by wy and along z by wz; rows along x remain.
template <class Real, int padded>
void gather(Real const* corner, int width, long row, long stride_z, Real const* wy, Real const* wz,
            Row<Real, padded> (&sum)[3]) {
  using R = Row<Real, padded>;
  for (R& s : sum) s = R::zero();
  for (int jz = 0; jz < width; ++jz) {
    R plane[3] = {R::zero(), R::zero(), R::zero()};
    for (int jy = 0; jy < width; ++jy)
      for (int c = 0; c < 3; ++c)
        plane[c].add_product(R::from(corner + jz * stride_z + (jy * 3 + c) * row), wy[jy]);
    for (int c = 0; c < 3; ++c) sum[c].add_product(plane[c], wz[jz]);
  }
}

template <class Real, int padded>
void interpolate_rows(WindowView<Real> const& window, PatchView<Real> const& patch, long tile, double const* points,
                      Real const* grid, double* velocity, double* gradient) {
  using R = Row<Real, padded>;
  long const row = patch.velocity_row, stride_z = (patch.target_high[1] - patch.target_low[1]) * 3 * row;
  double const slope_scale = patch.slope_scale;
  for (long k = patch.targets.begin[tile]; k < patch.targets.begin[tile + 1]; ++k) {
    long const i = patch.targets.index[k];
    GridPlace<Real> const place(patch, points + 3 * i);
    R w[3], sum[3];
    weights<Real, padded>(window.coefficients, window.degree, place.z, w);
    Real wy[padded], wz[padded];
    w[1].to(wy);
    w[2].to(wz);
    Real const* const corner = grid + (place.first[2] - patch.target_low[2]) * stride_z +
                               (place.first[1] - patch.target_low[1]) * 3 * row + place.first[0] - patch.target_low[0];
    gather<Real, padded>(corner, window.width, row, stride_z, wy, wz, sum);
    for (int c = 0; c < 3; ++c) velocity[3 * i + c] += patch.scale * sum[c].dot(w[0]);
    if (!gradient) continue;
    R slopes[3];
    weights<Real, padded>(window.coefficients + (window.degree + 1) * padded, window.degree, place.z, slopes);
    for (int c = 0; c < 3; ++c) gradient[9 * i + 3 * c] += slope_scale * sum[c].dot(slopes[0]);
    Real sy[padded], sz[padded];
    slopes[1].to(sy);
    slopes[2].to(sz);
    gather<Real, padded>(corner, window.width, row, stride_z, sy, wz, sum);
    for (int c = 0; c < 3; ++c) gradient[9 * i + 3 * c + 1] += slope_scale * sum[c].dot(w[0]);
    gather<Real, padded>(corner, window.width, row, stride_z, wy, sz, sum);
    for (int c = 0; c < 3; ++c) gradient[9 * i + 3 * c + 2] += slope_scale * sum[c].dot(w[0]);
  }
}

}  // namespace
}  // namespace asterflow

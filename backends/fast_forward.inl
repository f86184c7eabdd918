// The first sweep of a patch's convolution: strengths spread onto a tile of the grid, which is transformed along x before it
// leaves the cache. Real rows are transformed in pairs, as real and imaginary part; vector lanes hold neighbours in y.

namespace asterflow {
namespace {

// Room for a line along x.
template <class Real>
long line_room(PatchView<Real> const& patch, long row) {
  return (patch.nodes[0] > patch.source_low[0] + row ? patch.nodes[0] : patch.source_low[0] + row) + lanes<Real>;
}

// The rows y0 ... y0 + lanes - 1 of one component of a plane of a tile, in vector lanes.
template <class Real, class Sum>
void rows_to_lanes(PatchView<Real> const& patch, TileGrid<Real, Sum> const& tile, Sum const* plane, int components, int y0,
                   Pack<Real>* line) {
  using P = Pack<Real>;
  constexpr int W = lanes<Real>;
  int const nx = patch.nodes[0], ny = tile.y_end - tile.y_begin, x_low = patch.source_low[0];
  for (int x = 0; x < x_low; ++x) line[x] = P{};
  for (long x = 0; x < tile.row; x += W) {
    P square[W];
    for (int i = 0; i < W; ++i)
      square[i] = y0 + i < ny ? load_as<Real>(plane + static_cast<long>(y0 + i) * components * tile.stride + x) * tile.unit : P{};
    transpose<Real>(square);
    for (int i = 0; i < W; ++i) line[x_low + x + i] = square[i];
  }
  for (long x = x_low + tile.row; x < nx; ++x) line[x] = P{};
  long const n_ghost = smaller(tile.row - nx, long(nx));
  for (long x = 0; x < n_ghost; ++x) line[x] += line[nx + x];
}

// One plane z of a tile; its rows in vector lanes, 2 lanes<Real> at a time.
template <class Real, class Sum>
void x_forward(PatchView<Real> const& patch, TileGrid<Real, Sum> const& tile, int z, int components, Real* spectrum,
               Pack<Real>* work) {
  using P = Pack<Real>;
  constexpr int W = lanes<Real>;
  int const nx = patch.nodes[0], n_kx = patch.modes[0] + 1, ny = tile.y_end - tile.y_begin;
  long const room = line_room(patch, tile.row), ys = patch.spectrum_row;
  Sum const* const grid = tile.grid + (z - tile.z_begin) * static_cast<long>(ny) * components * tile.stride;
  P *const re = work, *const im = re + room, *const work_re = im + room, *const work_im = work_re + room;
  Rows const needed = source_rows(patch);
  for (int c = 0; c < components; ++c)
    for (int y0 = 0; y0 < ny; y0 += 2 * W) {
      long const row = tile.y_begin - patch.used_low[1] + y0;
      if (row < needed.begin || row >= needed.end) continue;
      rows_to_lanes(patch, tile, grid + c * tile.stride, components, y0, re);
      rows_to_lanes(patch, tile, grid + c * tile.stride, components, y0 + W, im);
      bool const moved = transform_lines(patch.lines[0], re, im, work_re, work_im);
      P const *const fr = moved ? work_re : re, *const fi = moved ? work_im : im;
      bool const pair = row + W < ys;
      for (int k = 0; k < n_kx; ++k) {
        int const m = k == 0 ? 0 : nx - k;
        Real* const out = spectrum + spectrum_line(patch, c, z - patch.used_low[2], k) + row;
        store(out, fr[k] + fr[m]);
        store(out + ys, fi[k] - fi[m]);
        if (!pair) continue;
        store(out + W, fi[k] + fi[m]);
        store(out + ys + W, fr[m] - fr[k]);
      }
    }
}

// Zeroes what x_forward would write of a plane without sources.
template <class Real, class Sum>
void clear_plane(PatchView<Real> const& patch, TileGrid<Real, Sum> const& tile, int z, int components, Real* spectrum) {
  Rows const needed = source_rows(patch);
  long const first = tile.y_begin - patch.used_low[1], last = tile.y_end - patch.used_low[1];
  long const begin = first > needed.begin ? first : needed.begin;
  long const end = tile.y + 1 == patch.tiles_y ? needed.end : smaller(last, needed.end);
  for (int c = 0; c < components; ++c)
    for (int part = 0; part < 2 * (patch.modes[0] + 1) && begin < end; ++part)
      std::memset(spectrum + spectrum_line(patch, c, z - patch.used_low[2], 0) + part * patch.spectrum_row + begin, 0,
                  sizeof(Real) * (end - begin));
}

template <class Real>
long forward_scratch(WindowView<Real> const& window, PatchView<Real> const& patch, int components) {
  long const row = tile_row(patch, window.padded);
  constexpr long per_double = sizeof(double) / sizeof(Real);
  long const stride = window.sums_in_double ? per_double * tile_stride<double>(row) : tile_stride<Real>(row);
  return 4L * ((patch.tile_y * patch.tile_z + 1L) * components * stride + line_room(patch, row) * lanes<Real>);  // the last tiles are larger
}

// unit: see TileGrid.
template <class Real, class Sum>
void forward_of(WindowView<Real> const& window, PatchView<Real> const& patch, int components, long i_tile, Real unit,
                double const* points, Real const* strengths, Real* spectrum, Real* scratch) {
  auto* const work = reinterpret_cast<Pack<Real>*>(scratch);
  long const room = line_room(patch, tile_row(patch, window.padded));
  auto* const grid = reinterpret_cast<Sum*>(scratch + 4 * room * lanes<Real>);
  TileGrid<Real, Sum> tile(patch, i_tile, window.padded, grid);
  tile.unit = unit;
  tile.units = 1 / unit;
  bool is_empty = true;
  for_sources(patch, tile.y, tile.z, [&](long) { is_empty = false; });
  if (!is_empty && components == 3) spread<Real, Sum, 3>(window, patch, tile, points, strengths);
  if (!is_empty && components == 6) spread<Real, Sum, 6>(window, patch, tile, points, strengths);
  for (int z = tile.z_begin; z < tile.z_end; ++z) {
    if (z < patch.source_low[2] || z >= patch.source_high[2]) continue;
    if (is_empty)
      clear_plane(patch, tile, z, components, spectrum);
    else
      x_forward(patch, tile, z, components, spectrum, work);
  }
}

// The unit of whole numbers in which no sum at a tile's nodes goes beyond 32 bits; 0 where the rounding of shares to it
// would cost the velocity more than 1.3e-7 (many strengths in one place; fitted), or a strength is not finite.
inline float unit_of_shares(PatchView<float> const& patch, int components, long i_tile, float const* strengths) {
  constexpr float most_crowded = 4000.0f, most_units = 2.0e9f;  // sums of so many halves are far from 2^31 - 2e9
  float const crowding = patch.crowding[i_tile];
  if (crowding > most_crowded) return 0.0f;
  float largest = 0.0f;
  bool is_finite = true;
  for_sources(patch, static_cast<int>(i_tile % patch.tiles_y), static_cast<int>(i_tile / patch.tiles_y), [&](long i) {
    for (int c = 0; c < components; ++c) {
      float const size = std::fabs(strengths[i * components + c]);
      is_finite = is_finite && size < 1e30f;
      largest = size > largest ? size : largest;
    }
  });
  return is_finite && largest > 1e-25f ? crowding * largest / most_units : 0.0f;
}

template <class Real>
void forward(WindowView<Real> const& window, PatchView<Real> const& patch, int components, long tile,
             double const* points, Real const* strengths, Real* spectrum, Real* scratch) {
  if (!window.sums_in_double) return forward_of<Real, Real>(window, patch, components, tile, Real(1), points, strengths, spectrum, scratch);
  if constexpr (sizeof(Real) == 4) {
    float const unit = unit_of_shares(patch, components, tile, strengths);
    if (unit > 0.0f)
      return forward_of<Real, std::int32_t>(window, patch, components, tile, unit, points, strengths, spectrum, scratch);
  }
  forward_of<Real, double>(window, patch, components, tile, Real(1), points, strengths, spectrum, scratch);
}

}  // namespace
}  // namespace asterflow

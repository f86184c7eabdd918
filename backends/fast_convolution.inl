// The five sweeps of a patch's convolution: x forward, z forward, (y forward, symbol, y inverse), z inverse, x
// inverse. Only modes inside the band are kept, so later sweeps are shorter; lines that no source reaches are not
// transformed forward, those without targets not back. Real rows are transformed in
// pairs, as real and imaginary part. Vector lanes hold lines that are neighbours in y (x and z sweeps) or kx (y).

#include "backends/fast_symbol.inl"

namespace asterflow {
namespace {

constexpr double two_pi = 6.283185307179586;

// Largest |j2| such that (j1, j2) is inside the band, -1 if there is none.
inline int partner_modes(double band, int j1, int n1, int n2, int most) {
  double const k1 = two_pi * j1 / n1;
  double const rest = band * band - k1 * k1;
  return rest < 0.0 ? -1 : smaller(most, static_cast<int>(std::sqrt(rest) * n2 / two_pi));
}

// Rows of the spectrum, from used_low[1]: whole pairs of vectors, as the x sweeps transform them.
struct Rows {
  long begin, end;
};

// Those of nodes low ... high - 1; pairs begin at multiples of `unit`.
template <class Real>
Rows rows(PatchView<Real> const& patch, int low, int high, long unit) {
  constexpr long pair = 2 * lanes<Real>;
  if (low >= high) return {0, 0};
  long const begin = (low - patch.used_low[1]) / unit * unit;
  return {begin, smaller(patch.spectrum_row, begin + (high - patch.used_low[1] - begin + pair - 1) / pair * pair)};
}
template <class Real>
Rows source_rows(PatchView<Real> const& patch) {
  return rows(patch, patch.source_low[1], patch.source_high[1], 2 * lanes<Real>);
}
template <class Real>
Rows target_rows(PatchView<Real> const& patch) {
  return rows(patch, patch.target_low[1], patch.target_high[1], lanes<Real>);
}

// Where rows of mode kx of one plane lie in the spectrum; a row of imaginary parts follows.
template <class Real>
long spectrum_line(PatchView<Real> const& patch, int component, int plane, int kx) {
  return ((static_cast<long>(component) * patch.planes + plane) * (patch.modes[0] + 1) + kx) * 2 * patch.spectrum_row;
}

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
  return 4L * (patch.tile_y * patch.tile_z * components * stride + line_room(patch, row) * lanes<Real>);  // the last tiles are larger
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

// Lines along z of one component and kx, for all rows with sources or, back, targets.
template <class Real>
void z_sweep(PatchView<Real> const& patch, int component, int kx, bool inverse, Real* spectrum, Real* scratch) {
  using P = Pack<Real>;
  constexpr int W = lanes<Real>;
  int const nz = patch.nodes[2], n_planes = patch.planes, low = patch.used_low[2];
  long const ys = patch.spectrum_row, stride = 2 * (patch.modes[0] + 1L) * ys;
  int const most = partner_modes(patch.band, kx, patch.nodes[0], nz, patch.modes[2]);
  int const n_low = smaller(most + 1, nz), n_high = smaller(most, nz - n_low);  // modes 0 ... and those below 0
  P* const re = reinterpret_cast<P*>(scratch);
  P *const im = re + nz, *const work_re = im + nz, *const work_im = work_re + nz;
  Rows const needed = inverse ? target_rows(patch) : source_rows(patch);
  for (long y = needed.begin; y < needed.end; y += W) {
    Real* const base = spectrum + spectrum_line(patch, component, 0, kx) + y;
    auto const clear = [&](int begin, int end) {
      for (int z = begin; z < end; ++z) re[z] = im[z] = P{};
    };
    auto const get = [&](int begin, int end, int plane) {
      for (int z = begin; z < end; ++z, ++plane) re[z] = load(base + plane * stride), im[z] = load(base + plane * stride + ys);
    };
    if (inverse) {
      get(0, n_low, 0);
      clear(n_low, nz - n_high);
      get(nz - n_high, nz, n_planes - n_high);
    } else {
      clear(0, patch.source_low[2]);
      get(patch.source_low[2], patch.source_high[2], patch.source_low[2] - low);
      clear(patch.source_high[2], nz);
    }
    bool const moved = inverse ? transform_lines(patch.lines[2], im, re, work_im, work_re)
                               : transform_lines(patch.lines[2], re, im, work_re, work_im);
    P const *const fr = moved ? work_re : re, *const fi = moved ? work_im : im;
    auto const keep = [&](int begin, int end, int plane) {
      for (int z = begin; z < end; ++z, ++plane) store(base + plane * stride, fr[z]), store(base + plane * stride + ys, fi[z]);
    };
    if (inverse) {
      keep(patch.target_low[2], patch.target_high[2], patch.target_low[2] - low);
    } else {
      keep(0, n_low, 0);
      keep(nz - n_high, nz, n_planes - n_high);
    }
  }
}

// Numbers of a line along y in scratch: whole vectors of rows may end beyond its last node.
template <class Real>
long y_room(PatchView<Real> const& patch) {
  return (patch.nodes[1] + lanes<Real> - 1) / lanes<Real> * lanes<Real> + lanes<Real>;
}

// Lines along y of one kz: moved between the spectrum and scratch in squares.
template <class Real>
struct YLines {
  using P = Pack<Real>;
  static constexpr int W = lanes<Real>;
  PatchView<Real> const& patch;
  Real* spectrum;
  int plane, kx0, n;  // modes kx0 ... kx0 + n - 1 are inside the band

  YLines(PatchView<Real> const& p, Real* values, int jz, int first)
      : patch(p), spectrum(values), plane(jz < 0 ? jz + p.planes : jz), kx0(first), n(0) {
    int const abs_jz = jz < 0 ? -jz : jz;
    while (n < W && kx0 + n <= p.modes[0] && abs_jz <= partner_modes(p.band, kx0 + n, p.nodes[0], p.nodes[2], p.modes[2])) ++n;
  }
  Real* address(int c, int part, int i, long row) const {
    return spectrum + spectrum_line(patch, c, plane, kx0 + i) + part * patch.spectrum_row + row;
  }
  void get(P* line, int c, int part) const {
    Rows const needed = source_rows(patch);
    P* const used = line + patch.used_low[1];
    for (P* p = line; p < used + needed.begin; ++p) *p = P{};
    for (long row = needed.begin; row < needed.end; row += W) {
      P square[W];
      for (int i = 0; i < W; ++i) square[i] = i < n ? load(address(c, part, i, row)) : P{};
      transpose<Real>(square);
      for (int i = 0; i < W; ++i) used[row + i] = square[i];
    }
    for (P* p = used + needed.end; p < line + patch.nodes[1]; ++p) *p = P{};
  }
  void put(P const* line, int c, int part) const {
    Rows const needed = target_rows(patch);
    for (long row = needed.begin; row < needed.end; row += W) {
      P square[W];
      for (int i = 0; i < W; ++i) square[i] = line[patch.used_low[1] + row + i];
      transpose<Real>(square);
      for (int i = 0; i < n; ++i) store(address(c, part, i, row), square[i]);
    }
  }
};

// Multiplies the modes kx0 ... kx0 + W - 1, all ky, by the symbol. lines [components, 2, y_room].
template <class Real, class Symbol>
void apply_symbol(PatchView<Real> const& patch, int jz, int kx0, Pack<Real>* lines) {
  using P = Pack<Real>;
  constexpr int n_in = Symbol::components;
  int const ny = patch.nodes[1];
  long const ys = y_room(patch), abs_jz = jz < 0 ? -jz : jz;
  P k[3];
  for (int i = 0; i < lanes<Real>; ++i) k[0][i] = static_cast<Real>((kx0 + i) * two_pi / patch.nodes[0]);
  k[2] = broadcast(static_cast<Real>(two_pi * jz / patch.nodes[2]));
  for (int y = 0; y < ny; ++y) {
    int const jy = y <= ny / 2 ? y : y - ny, abs_jy = jy < 0 ? -jy : jy;
    P u_re[3] = {P{}, P{}, P{}}, u_im[3] = {P{}, P{}, P{}};
    if (abs_jy <= patch.modes[1]) {
      k[1] = broadcast(static_cast<Real>(two_pi * jy / ny));
      long const row = abs_jz * (patch.modes[1] + 1) + abs_jy;
      P f_re[n_in], f_im[n_in];
      for (int c = 0; c < n_in; ++c) f_re[c] = lines[2 * c * ys + y], f_im[c] = lines[(2 * c + 1) * ys + y];
      Symbol::apply(k, load(patch.symbol + row * patch.symbol_stride + kx0), f_re, f_im, u_re, u_im);
    }
    for (int d = 0; d < 3; ++d) lines[2 * d * ys + y] = u_re[d], lines[(2 * d + 1) * ys + y] = u_im[d];
  }
}

template <class Real, class Symbol>
void y_sweep_of(PatchView<Real> const& patch, int jz, Real* spectrum, Real* scratch) {
  using P = Pack<Real>;
  constexpr int n_in = Symbol::components;
  int const ny = patch.nodes[1];
  long const ys = y_room(patch);
  P* const lines = reinterpret_cast<P*>(scratch);
  P *const work_re = lines + 2 * n_in * ys, *const work_im = work_re + ys;
  for (int kx0 = 0; kx0 <= patch.modes[0]; kx0 += lanes<Real>) {
    YLines<Real> const outside(patch, spectrum, jz, kx0);
    if (outside.n == 0) break;
    for (int c = 0; c < n_in; ++c) {
      P *const re = lines + 2 * c * ys, *const im = re + ys;
      outside.get(re, c, 0);
      outside.get(im, c, 1);
      if (!transform_lines(patch.lines[1], re, im, work_re, work_im)) continue;
      std::memcpy(re, work_re, sizeof(P) * ny);
      std::memcpy(im, work_im, sizeof(P) * ny);
    }
    apply_symbol<Real, Symbol>(patch, jz, kx0, lines);
    for (int d = 0; d < 3; ++d) {
      P *const re = lines + 2 * d * ys, *const im = re + ys;
      bool const moved = transform_lines(patch.lines[1], im, re, work_im, work_re);
      P *const out_re = moved ? work_re : re, *const out_im = moved ? work_im : im;
      for (long y = ny; y < ys; ++y) out_re[y] = out_im[y] = P{};  // they share lanes with rows of the grid
      outside.put(out_re, d, 0);
      outside.put(out_im, d, 1);
    }
  }
}

template <class Real>
void y_sweep(PatchView<Real> const& patch, FastKernel kernel, int kz, Real* spectrum, Real* scratch) {
  if (kernel == FastKernel::stokeslet) return y_sweep_of<Real, StokesletSymbol>(patch, kz, spectrum, scratch);
  if (kernel == FastKernel::rotlet) return y_sweep_of<Real, RotletSymbol>(patch, kz, spectrum, scratch);
  if (kernel == FastKernel::stokeslet_pressure) return y_sweep_of<Real, StokesletPressureSymbol>(patch, kz, spectrum, scratch);
  if (kernel == FastKernel::stresslet_pressure) return y_sweep_of<Real, StressletPressureSymbol>(patch, kz, spectrum, scratch);
  y_sweep_of<Real, StressletSymbol>(patch, kz, spectrum, scratch);
}

template <class Real>
void x_inverse(PatchView<Real> const& patch, int z, Real const* spectrum, Real* grid, Real* scratch) {
  using P = Pack<Real>;
  constexpr int W = lanes<Real>;
  int const nx = patch.nodes[0], n_kx = patch.modes[0] + 1, y_low = patch.target_low[1], y_high = patch.target_high[1];
  Rows const needed = target_rows(patch);
  long const ys = patch.spectrum_row, row = patch.velocity_row, x_low = patch.target_low[0];
  long const n_line = smaller(x_low + row, static_cast<long>(nx)), room = nx + row + W;
  Real* const plane = grid + (z - patch.target_low[2]) * static_cast<long>(y_high - y_low) * 3 * row;
  P* const re = reinterpret_cast<P*>(scratch);
  P *const im = re + room, *const work_re = im + room, *const work_im = work_re + room;
  for (int c = 0; c < 3; ++c)
    for (long first = needed.begin; first < needed.end; first += 2 * W) {
      bool const pair = first + W < ys;
      for (int k = 0; k < n_kx; ++k) {
        Real const* const in = spectrum + spectrum_line(patch, c, z - patch.used_low[2], k) + first;
        P const ar = load(in), ai = load(in + ys), br = pair ? load(in + W) : P{}, bi = pair ? load(in + ys + W) : P{};
        if (k > 0) {
          re[nx - k] = ar + bi;
          im[nx - k] = br - ai;
          re[k] = ar - bi;
          im[k] = ai + br;
        } else {
          re[0] = ar;
          im[0] = br;
        }
      }
      for (int x = n_kx; x <= nx - n_kx; ++x) re[x] = im[x] = P{};
      bool const moved = transform_lines(patch.lines[0], im, re, work_im, work_re);
      for (int part = 0; part < 2; ++part) {
        P* const line = part == 0 ? (moved ? work_re : re) : (moved ? work_im : im);
        for (long x = n_line; x < x_low + row; ++x) line[x] = P{};
        for (long x = 0; x < row; x += W) {
          P square[W];
          for (int i = 0; i < W; ++i) square[i] = line[x_low + x + i];
          transpose<Real>(square);
          for (int i = 0; i < W; ++i) {
            long const y = patch.used_low[1] + first + part * W + i;
            if (y >= y_low && y < y_high) store(plane + ((y - y_low) * 3 + c) * row + x, square[i]);
          }
        }
      }
    }
}

// Of the z, y and x sweeps, in numbers.
template <class Real>
long sweep_scratch(PatchView<Real> const& patch) {
  long const along_z = 4L * patch.nodes[2], along_y = 14L * y_room(patch),
             along_x = 4L * (patch.nodes[0] + patch.velocity_row + lanes<Real>);
  long const most = along_x > along_y ? along_x : along_y;
  return lanes<Real> * (most > along_z ? most : along_z);
}

}  // namespace
}  // namespace asterflow

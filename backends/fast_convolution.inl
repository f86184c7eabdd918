// The five sweeps of a patch's convolution: x forward, z forward, (y forward, symbol, y inverse), z inverse, x
// inverse. Only modes inside the band are kept, so later sweeps are shorter. Real rows are transformed in
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

// One plane z of a tile, rows from y_begin; its rows in vector lanes, 2 lanes<Real> at a time.
template <class Real, class Sum>
void x_forward(PatchView<Real> const& patch, TileGrid<Real, Sum> const& tile, int z, int components, Real* spectrum,
               Pack<Real>* work) {
  using P = Pack<Real>;
  constexpr int W = lanes<Real>;
  int const nx = patch.nodes[0], n_kx = patch.modes[0] + 1, ny = tile.y_end - tile.y_begin;
  long const row = tile.row, n_ghost = smaller(row - nx, long(nx)), ys = patch.spectrum_row;
  Sum const* const grid = tile.grid + (z - tile.z_begin) * static_cast<long>(ny) * components * tile.stride;
  P *const re = work, *const im = re + row, *const work_re = im + row, *const work_im = work_re + row;
  for (int c = 0; c < components; ++c)
    for (int y0 = 0; y0 < ny; y0 += 2 * W) {
      for (int part = 0; part < 2; ++part) {
        P* const line = part == 0 ? re : im;
        for (long x = 0; x < row; x += W) {
          P square[W];
          for (int i = 0; i < W; ++i) {
            int const y = y0 + part * W + i;
            square[i] = y < ny ? load_as<Real>(grid + (static_cast<long>(y) * components + c) * tile.stride + x) : P{};
          }
          transpose<Real>(square);
          for (int i = 0; i < W; ++i) line[x + i] = square[i];
        }
        for (long x = 0; x < n_ghost; ++x) line[x] += line[nx + x];
      }
      bool const moved = transform_lines(patch.lines[0], re, im, work_re, work_im);
      P const *const fr = moved ? work_re : re, *const fi = moved ? work_im : im;
      bool const pair = tile.y_begin + y0 + W < ys;
      for (int k = 0; k < n_kx; ++k) {
        int const m = k == 0 ? 0 : nx - k;
        Real* const out = spectrum + ((c * static_cast<long>(patch.nodes[2]) + z) * n_kx + k) * 2 * ys + tile.y_begin + y0;
        store(out, fr[k] + fr[m]);
        store(out + ys, fi[k] - fi[m]);
        if (!pair) continue;
        store(out + W, fi[k] + fi[m]);
        store(out + ys + W, fr[m] - fr[k]);
      }
    }
}

template <class Real>
long forward_scratch(WindowView<Real> const& window, PatchView<Real> const& patch, int components) {
  long const row = tile_row(patch, window.padded);
  constexpr long per_double = sizeof(double) / sizeof(Real);
  long const stride = window.sums_in_double ? per_double * tile_stride<double>(row) : tile_stride<Real>(row);
  return 4L * (patch.tile_y * patch.tile_z * components * stride + row * lanes<Real>);  // the last tiles are larger
}

template <class Real, class Sum>
void forward_of(WindowView<Real> const& window, PatchView<Real> const& patch, int components, long i_tile,
                double const* points, Real const* strengths, Real* spectrum, Real* scratch) {
  auto* const work = reinterpret_cast<Pack<Real>*>(scratch);
  long const row = tile_row(patch, window.padded);
  auto* const grid = reinterpret_cast<Sum*>(scratch + 4 * row * lanes<Real>);
  TileGrid<Real, Sum> const tile(patch, i_tile, window.padded, grid);
  if (components == 3)
    spread<Real, Sum, 3>(window, patch, tile, points, strengths);
  else
    spread<Real, Sum, 6>(window, patch, tile, points, strengths);
  for (int z = tile.z_begin; z < tile.z_end; ++z) x_forward(patch, tile, z, components, spectrum, work);
}

template <class Real>
void forward(WindowView<Real> const& window, PatchView<Real> const& patch, int components, long tile,
             double const* points, Real const* strengths, Real* spectrum, Real* scratch) {
  if (window.sums_in_double)
    forward_of<Real, double>(window, patch, components, tile, points, strengths, spectrum, scratch);
  else
    forward_of<Real, Real>(window, patch, components, tile, points, strengths, spectrum, scratch);
}

// Lines along z of one component and kx, for all y.
template <class Real>
void z_sweep(PatchView<Real> const& patch, int component, int kx, bool inverse, Real* spectrum, Real* scratch) {
  using P = Pack<Real>;
  constexpr int W = lanes<Real>;
  int const nz = patch.nodes[2], n_kx = patch.modes[0] + 1;
  long const ys = patch.spectrum_row, stride = 2 * n_kx * ys;
  int const most = partner_modes(patch.band, kx, patch.nodes[0], nz, patch.modes[2]);
  P* const re = reinterpret_cast<P*>(scratch);
  P *const im = re + nz, *const work_re = im + nz, *const work_im = work_re + nz;
  long const y_begin = inverse ? patch.target_low[1] / W * W : 0;
  // Whole pairs of vectors, as the x sweep transforms them.
  long const y_end =
      inverse ? smaller(ys, y_begin + (patch.target_high[1] - y_begin + 2 * W - 1) / (2 * W) * 2 * W) : ys;
  for (long y = y_begin; y < y_end; y += W) {
    Real* const base = spectrum + (static_cast<long>(component) * nz * n_kx + kx) * 2 * ys + y;
    for (int z = 0; z < nz; ++z) {
      bool const kept = !inverse || z <= most || z >= nz - most;
      re[z] = kept ? load(base + z * stride) : P{};
      im[z] = kept ? load(base + z * stride + ys) : P{};
    }
    bool const moved = inverse ? transform_lines(patch.lines[2], im, re, work_im, work_re)
                               : transform_lines(patch.lines[2], re, im, work_re, work_im);
    P const *const fr = moved ? work_re : re, *const fi = moved ? work_im : im;
    auto const keep = [&](int z) {
      store(base + z * stride, fr[z]);
      store(base + z * stride + ys, fi[z]);
    };
    if (inverse) {
      for (int z = patch.target_low[2]; z < patch.target_high[2]; ++z) keep(z);
    } else {
      for (int z = 0; z <= most; ++z) keep(z);
      for (int z = nz - most; z < nz; ++z) keep(z);
    }
  }
}

// Lines along y of one kz: moved between the spectrum and scratch in squares.
template <class Real>
struct YLines {
  using P = Pack<Real>;
  static constexpr int W = lanes<Real>;
  PatchView<Real> const& patch;
  Real* spectrum;
  int z;

  Real* address(int c, int part, int kx, long y) const {
    long const n_kx = patch.modes[0] + 1;
    return spectrum + (((static_cast<long>(c) * patch.nodes[2] + z) * n_kx + kx) * 2 + part) * patch.spectrum_row + y;
  }
  void get(P* line, int c, int part, int kx0) const {
    int const n = smaller(W, patch.modes[0] + 1 - kx0);
    for (long y = 0; y < patch.spectrum_row; y += W) {
      P square[W];
      for (int i = 0; i < W; ++i) square[i] = i < n ? load(address(c, part, kx0 + i, y)) : P{};
      transpose<Real>(square);
      for (int i = 0; i < W; ++i) line[y + i] = square[i];
    }
  }
  void put(P const* line, int c, int part, int kx0) const {
    int const n = smaller(W, patch.modes[0] + 1 - kx0);
    for (long y = 0; y < patch.spectrum_row; y += W) {
      P square[W];
      for (int i = 0; i < W; ++i) square[i] = line[y + i];
      transpose<Real>(square);
      for (int i = 0; i < n; ++i) store(address(c, part, kx0 + i, y), square[i]);
    }
  }
};

// Multiplies the modes kx0 ... kx0 + W - 1, all ky, by the symbol. lines [components, 2, spectrum_row].
template <class Real, class Symbol>
void apply_symbol(PatchView<Real> const& patch, int jz, int kx0, Pack<Real>* lines) {
  using P = Pack<Real>;
  constexpr int n_in = Symbol::components;
  int const ny = patch.nodes[1];
  long const ys = patch.spectrum_row, abs_jz = jz < 0 ? -jz : jz;
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
  long const ys = patch.spectrum_row;
  P* const lines = reinterpret_cast<P*>(scratch);
  P *const work_re = lines + 2 * n_in * ys, *const work_im = work_re + ys;
  YLines<Real> const outside{patch, spectrum, jz < 0 ? jz + patch.nodes[2] : jz};
  for (int kx0 = 0; kx0 <= patch.modes[0]; kx0 += lanes<Real>) {
    if ((jz < 0 ? -jz : jz) > partner_modes(patch.band, kx0, patch.nodes[0], patch.nodes[2], patch.modes[2])) break;
    for (int c = 0; c < n_in; ++c) {
      P *const re = lines + 2 * c * ys, *const im = re + ys;
      outside.get(re, c, 0, kx0);
      outside.get(im, c, 1, kx0);
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
      outside.put(out_re, d, 0, kx0);
      outside.put(out_im, d, 1, kx0);
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
  long const ys = patch.spectrum_row, row = patch.velocity_row, x_low = patch.target_low[0];
  long const n_line = smaller(x_low + row, static_cast<long>(nx)), room = nx + row + W;
  Real* const plane = grid + (z - patch.target_low[2]) * static_cast<long>(y_high - y_low) * 3 * row;
  P* const re = reinterpret_cast<P*>(scratch);
  P *const im = re + room, *const work_re = im + room, *const work_im = work_re + room;
  for (int c = 0; c < 3; ++c)
    for (int y0 = y_low / W * W; y0 < y_high; y0 += 2 * W) {
      bool const pair = y0 + W < ys;
      for (int k = 0; k < n_kx; ++k) {
        Real const* const in = spectrum + ((c * static_cast<long>(patch.nodes[2]) + z) * n_kx + k) * 2 * ys + y0;
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
            int const y = y0 + part * W + i;
            if (y >= y_low && y < y_high) store(plane + (static_cast<long>(y - y_low) * 3 + c) * row + x, square[i]);
          }
        }
      }
    }
}

// Of the z, y and x sweeps, in numbers.
template <class Real>
long sweep_scratch(PatchView<Real> const& patch) {
  long const along_z = 4L * patch.nodes[2], along_y = 14L * patch.spectrum_row,
             along_x = 4L * (patch.nodes[0] + patch.velocity_row + lanes<Real>);
  long const most = along_x > along_y ? along_x : along_y;
  return lanes<Real> * (most > along_z ? most : along_z);
}

}  // namespace
}  // namespace asterflow

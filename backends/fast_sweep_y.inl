// The middle of a patch's convolution: along y, multiplication by the kernel's symbol, back along y. Vector lanes hold
// lines that are neighbours in kx.

#include "backends/fast_symbol.inl"

namespace asterflow {
namespace {

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

}  // namespace
}  // namespace asterflow

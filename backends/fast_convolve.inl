// The middle of a patch's convolution, for one wave number kx at a time: along z, along y, multiplication by the kernel's
// symbol, back along y, back along z. What one kx needs stays in the cache meanwhile.

#include "backends/fast_symbol.inl"

namespace asterflow {
namespace {

// The modes kz of one kx within the band, side by side in two halves: kz = 0, 1, ... and 0, -1, -2, ... (the second 0 is not
// used), each as whole vectors. Rows of them are an odd number of cache lines apart, see tile_stride().
template <class Real>
struct PlaneModes {
  int nz, last;  // largest |kz|
  long half, stride;

  PlaneModes(PatchView<Real> const& patch, int kx)
      : nz(patch.nodes[2]), last(partner_modes(patch.band, kx, patch.nodes[0], nz, patch.modes[2])), half(half_row(last)), stride(row_stride(half)) {}

  static long half_row(int last) { return (last + lanes<Real>) / lanes<Real> * lanes<Real>; }
  static long row_stride(long half) { return tile_stride<Real>(2 * half); }

  // Where column m lies on a line of nz modes; beyond the band anywhere on it.
  int on_line(long m) const {
    long const k = m < half ? m : m - half;
    return k == 0 || k > last ? 0 : static_cast<int>(m < half ? k : nz - k);
  }
};

// [component, 2, y, kz] of one kx, y from used_low[1].
template <class Real>
struct ModePlane {
  PatchView<Real> const& patch;
  PlaneModes<Real> modes;
  Real* values;

  ModePlane(PatchView<Real> const& p, int kx, Real* memory) : patch(p), modes(p, kx), values(memory) {}

  Real* row(int component, int part, long y) const { return values + ((2L * component + part) * patch.spectrum_row + y) * modes.stride; }

  static long room(PatchView<Real> const& patch, int components) {
    return 2L * components * patch.spectrum_row * PlaneModes<Real>::row_stride(PlaneModes<Real>::half_row(patch.modes[2]));
  }
};

// Forward along z: lines of one component, rows with sources, from the spectrum into the plane. Vector lanes hold neighbours in y.
template <class Real>
void z_forward(ModePlane<Real> const& plane, int component, int kx, Real const* spectrum, Pack<Real>* work) {
  using P = Pack<Real>;
  constexpr int W = lanes<Real>;
  PatchView<Real> const& patch = plane.patch;
  int const nz = patch.nodes[2], low = patch.source_low[2], high = patch.source_high[2];
  long const ys = patch.spectrum_row;
  P *const re = work, *const im = re + nz, *const work_re = im + nz, *const work_im = work_re + nz;
  Rows const needed = source_rows(patch);
  for (long y = needed.begin; y < needed.end; y += W) {
    for (int z = 0; z < low; ++z) re[z] = im[z] = P{};
    for (int z = low; z < high; ++z) {
      Real const* const from = spectrum + spectrum_line(patch, component, z - patch.used_low[2], kx) + y;
      re[z] = load(from), im[z] = load(from + ys);
    }
    for (int z = high; z < nz; ++z) re[z] = im[z] = P{};
    bool const moved = transform_lines(patch.lines[2], re, im, work_re, work_im);
    for (int part = 0; part < 2; ++part) {
      P const* const line = part == 0 ? (moved ? work_re : re) : (moved ? work_im : im);
      for (long m = 0; m < 2 * plane.modes.half; m += W) {
        P square[W];
        for (int i = 0; i < W; ++i) square[i] = line[plane.modes.on_line(m + i)];
        transpose<Real>(square);
        for (int i = 0; i < W; ++i) store(plane.row(component, part, y + i) + m, square[i]);
      }
    }
  }
}

// Back along z: rows with targets, from the plane into the spectrum.
template <class Real>
void z_inverse(ModePlane<Real> const& plane, int component, int kx, Real* spectrum, Pack<Real>* work) {
  using P = Pack<Real>;
  constexpr int W = lanes<Real>;
  PatchView<Real> const& patch = plane.patch;
  int const nz = patch.nodes[2];
  long const ys = patch.spectrum_row;
  PlaneModes<Real> const& modes = plane.modes;
  P *const re = work, *const im = re + nz, *const work_re = im + nz, *const work_im = work_re + nz;
  Rows const needed = target_rows(patch);
  for (long y = needed.begin; y < needed.end; y += W) {
    for (int part = 0; part < 2; ++part) {
      P* const line = part == 0 ? re : im;
      for (long m = 0; m < 2 * modes.half; m += W) {
        P square[W];
        for (int i = 0; i < W; ++i) square[i] = load(plane.row(component, part, y + i) + m);
        transpose<Real>(square);
        for (int i = 0; i < W; ++i) {
          long const k = m < modes.half ? m + i : m + i - modes.half;
          if (k <= modes.last && m + i != modes.half) line[modes.on_line(m + i)] = square[i];
        }
      }
      for (int z = modes.last + 1; z < nz - modes.last; ++z) line[z] = P{};
    }
    bool const moved = transform_lines(patch.lines[2], im, re, work_im, work_re);
    P const *const fr = moved ? work_re : re, *const fi = moved ? work_im : im;
    for (int z = patch.target_low[2]; z < patch.target_high[2]; ++z) {
      Real* const to = spectrum + spectrum_line(patch, component, z - patch.used_low[2], kx) + y;
      store(to, fr[z]), store(to + ys, fi[z]);
    }
  }
}

// Multiplies the modes kx, ky, kz of a vector of kz by the symbol, all ky. in [components], out [3]: lines of real and imaginary parts.
template <class Real, class Symbol>
void apply_symbol(PatchView<Real> const& patch, int kx, long m, long half, Pack<Real>* const (&in)[Symbol::components][2],
                  Pack<Real>* const (&out)[3][2]) {
  using P = Pack<Real>;
  constexpr int n_in = Symbol::components;
  int const ny = patch.nodes[1];
  long const first = m < half ? m : m - half;  // |kz|
  int const last = partner_modes(patch.band, kx, patch.nodes[0], ny, patch.modes[1]);
  P k[3];
  k[0] = broadcast(static_cast<Real>(two_pi * kx / patch.nodes[0]));
  for (int i = 0; i < lanes<Real>; ++i) k[2][i] = static_cast<Real>((m < half ? 1 : -1) * (first + i) * two_pi / patch.nodes[2]);
  for (int y = last + 1; y < ny - last; ++y)
    for (int d = 0; d < 3; ++d) out[d][0][y] = out[d][1][y] = P{};
  for (int jy = -last; jy <= last; ++jy) {
    int const y = jy < 0 ? jy + ny : jy;
    k[1] = broadcast(static_cast<Real>(two_pi * jy / ny));
    P f_re[n_in], f_im[n_in], u_re[3] = {P{}, P{}, P{}}, u_im[3] = {P{}, P{}, P{}};
    for (int c = 0; c < n_in; ++c) f_re[c] = in[c][0][y], f_im[c] = in[c][1][y];
    long const row = kx * (patch.modes[1] + 1L) + (jy < 0 ? -jy : jy);
    Symbol::apply(k, load(patch.symbol + row * patch.symbol_stride + first), f_re, f_im, u_re, u_im);
    for (int d = 0; d < 3; ++d) out[d][0][y] = u_re[d], out[d][1][y] = u_im[d];
  }
}

// Along y and back, in place. Vector lanes hold neighbours in kz.
template <class Real, class Symbol>
void y_convolve(ModePlane<Real> const& plane, int kx, Pack<Real>* work) {
  using P = Pack<Real>;
  constexpr int n_in = Symbol::components;
  PatchView<Real> const& patch = plane.patch;
  int const ny = patch.nodes[1], low = patch.used_low[1];
  long const ys = y_room(patch);
  Rows const sources = source_rows(patch), targets = target_rows(patch);
  P *const lines = work, *const others = lines + 2 * n_in * ys;
  for (long m = 0; m < 2 * plane.modes.half; m += lanes<Real>) {
    P *in[n_in][2], *out[3][2];
    for (int c = 0; c < n_in; ++c) {
      P *const re = lines + 2 * c * ys, *const im = re + ys, *const other_re = others + 2 * c * ys, *const other_im = other_re + ys;
      for (int part = 0; part < 2; ++part) {
        P* const line = part == 0 ? re : im;
        for (P* p = line; p < line + low + sources.begin; ++p) *p = P{};
        for (long y = sources.begin; y < sources.end; ++y) line[low + y] = load(plane.row(c, part, y) + m);
        for (P* p = line + low + sources.end; p < line + ny; ++p) *p = P{};
      }
      bool const moved = transform_lines(patch.lines[1], re, im, other_re, other_im);
      in[c][0] = moved ? other_re : re, in[c][1] = moved ? other_im : im;
      if (c < 3) out[c][0] = moved ? re : other_re, out[c][1] = moved ? im : other_im;
    }
    apply_symbol<Real, Symbol>(patch, kx, m, plane.modes.half, in, out);
    for (int d = 0; d < 3; ++d) {
      P *const re = out[d][0], *const im = out[d][1], *const free_re = in[d][0], *const free_im = in[d][1];
      bool const moved = transform_lines(patch.lines[1], im, re, free_im, free_re);
      for (int part = 0; part < 2; ++part) {
        P* const line = part == 0 ? (moved ? free_re : re) : (moved ? free_im : im);
        for (long y = targets.begin; y < targets.end; ++y) store(plane.row(d, part, y) + m, low + y < ny ? line[low + y] : P{});
      }
    }
  }
}

template <class Real, class Symbol>
void convolve_of(PatchView<Real> const& patch, int kx, Real* spectrum, Real* scratch) {
  constexpr int n_in = Symbol::components;
  ModePlane<Real> const plane(patch, kx, scratch);
  auto* const work = reinterpret_cast<Pack<Real>*>(scratch + ModePlane<Real>::room(patch, n_in));
  for (int c = 0; c < n_in; ++c) z_forward(plane, c, kx, spectrum, work);
  y_convolve<Real, Symbol>(plane, kx, work);
  for (int d = 0; d < 3; ++d) z_inverse(plane, d, kx, spectrum, work);
}

template <class Real>
void convolve(PatchView<Real> const& patch, FastKernel kernel, int kx, Real* spectrum, Real* scratch) {
  if (kernel == FastKernel::stokeslet) return convolve_of<Real, StokesletSymbol>(patch, kx, spectrum, scratch);
  if (kernel == FastKernel::rotlet) return convolve_of<Real, RotletSymbol>(patch, kx, spectrum, scratch);
  if (kernel == FastKernel::stokeslet_pressure) return convolve_of<Real, StokesletPressureSymbol>(patch, kx, spectrum, scratch);
  if (kernel == FastKernel::stresslet_pressure) return convolve_of<Real, StressletPressureSymbol>(patch, kx, spectrum, scratch);
  convolve_of<Real, StressletSymbol>(patch, kx, spectrum, scratch);
}

// In numbers.
template <class Real>
long convolve_scratch(PatchView<Real> const& patch, int components) {
  long const along_z = 4L * patch.nodes[2], along_y = 4L * components * y_room(patch);
  return ModePlane<Real>::room(patch, components) + lanes<Real> * (along_y > along_z ? along_y : along_z);
}

}  // namespace
}  // namespace asterflow

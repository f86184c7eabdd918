// The sweeps along z of a patch's convolution; vector lanes hold lines that are neighbours in y.

namespace asterflow {
namespace {

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

}  // namespace
}  // namespace asterflow

// The last sweep of a patch's convolution: back along x, into the grid of velocities. Real rows are transformed in pairs, as
// real and imaginary part; vector lanes hold neighbours in y.

namespace asterflow {
namespace {

// In numbers.
template <class Real>
long inverse_scratch(PatchView<Real> const& patch) {
  return 4L * (patch.nodes[0] + patch.velocity_row + lanes<Real>) * lanes<Real>;
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

}  // namespace
}  // namespace asterflow

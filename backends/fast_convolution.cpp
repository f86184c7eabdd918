#include "backends/fast_convolution.hpp"

#include "backends/fast_symbol.hpp"

#include <algorithm>
#include <array>

namespace asterflow {
namespace {

// Scratch lines of this thread, grown on demand.
template <class P>
P* scratch(std::size_t n) {
  static thread_local std::vector<P> lines;
  if (lines.size() < n) lines.resize(n);
  return lines.data();
}

// Largest |j2| such that (j1, j2) is inside the band, -1 if there is none.
int partner_modes(double band, int j1, int n1, int n2, int most) {
  double const k1 = 2.0 * M_PI * j1 / n1;
  double const rest = band * band - k1 * k1;
  return rest < 0.0 ? -1 : std::min(most, static_cast<int>(std::sqrt(rest) * n2 / (2.0 * M_PI)));
}

long padded_rows(int n_y, int n_lane) { return (n_y + n_lane - 1) / n_lane * n_lane; }

}  // namespace

int transform_length(int n) {
  for (int length = n + n % 2;; length += 2) {
    int rest = length;
    for (int factor : {2, 3, 5})
      while (rest % factor == 0) rest /= factor;
    if (rest == 1) return length;
  }
}

template <class Real>
GridConvolution<Real>::GridConvolution(std::string_view kernel, int components)
    : kernel_(kernel), components_(components) {}

template <class Real>
void GridConvolution<Real>::prepare(int length) {
  transforms_.try_emplace(length, length);
}

template <class Real>
long GridConvolution<Real>::spectrum_size(Patch<Real> const& patch) const {
  return 2L * components_ * patch.nodes[2] * (patch.symbol->modes[0] + 1) * padded_rows(patch.nodes[1], W);
}

template <class Real>
long GridConvolution<Real>::n_items(Patch<Real> const& patch, Sweep sweep) const {
  switch (sweep) {
    case Sweep::x_forward: return patch.nodes[2];
    case Sweep::z_forward: return static_cast<long>(components_) * (patch.symbol->modes[0] + 1);
    case Sweep::y_and_symbol: return 2L * patch.symbol->modes[2] + 1;
    case Sweep::z_inverse: return 3L * (patch.symbol->modes[0] + 1);
    case Sweep::x_inverse: return patch.target_high[2] - patch.target_low[2];
  }
  return 0;
}

template <class Real>
void GridConvolution<Real>::run(Patch<Real> const& patch, Sweep sweep, long item, long row, Real* grid,
                                Real* spectrum) const {
  int const n_kx = patch.symbol->modes[0] + 1;
  int const i = static_cast<int>(item);
  switch (sweep) {
    case Sweep::x_forward: return x_forward(patch, item, row, grid, spectrum);
    case Sweep::z_forward: return z_sweep(patch, i / n_kx, i % n_kx, false, spectrum);
    case Sweep::z_inverse: return z_sweep(patch, i / n_kx, i % n_kx, true, spectrum);
    case Sweep::x_inverse: return x_inverse(patch, patch.target_low[2] + item, row, grid, spectrum);
    case Sweep::y_and_symbol:
      int const kz = i - patch.symbol->modes[2];
      if (kernel_ == "stokeslet") return y_sweep<StokesletSymbol>(patch, kz, spectrum);
      if (kernel_ == "rotlet") return y_sweep<RotletSymbol>(patch, kz, spectrum);
      return y_sweep<StressletSymbol>(patch, kz, spectrum);
  }
}

template <class Real>
void GridConvolution<Real>::x_forward(Patch<Real> const& patch, long z, long row, Real const* grid,
                                      Real* spectrum) const {
  int const nx = patch.nodes[0], ny = patch.nodes[1], n_kx = patch.symbol->modes[0] + 1;
  long const ys = padded_rows(ny, W), n_ghost = std::min<long>(row - nx, nx);
  auto const& transform = transforms_.at(nx);
  long const n_block = (row + W - 1) / W * W;
  P* const re = scratch<P>(4 * n_block);
  P* const im = re + n_block;
  for (int c = 0; c < components_; ++c)
    for (long y0 = 0; y0 < ny; y0 += 2 * W) {
      for (int part = 0; part < 2; ++part) {
        P* const line = part == 0 ? re : im;
        for (long x = 0; x < row; x += W) {
          P square[W];
          for (int i = 0; i < W; ++i) {
            long const y = y0 + part * W + i;
            square[i] = y < ny ? load(grid + ((z * ny + y) * components_ + c) * row + x) : P{};
          }
          transpose<Real>(square);
          for (int i = 0; i < W; ++i) line[x + i] = square[i];
        }
        for (long x = 0; x < n_ghost; ++x) line[x] += line[nx + x];
      }
      bool const moved = transform.forward(re, im, im + n_block, im + 2 * n_block);
      P const* const fr = moved ? im + n_block : re;
      P const* const fi = moved ? im + 2 * n_block : im;
      bool const pair = y0 + W < ys;
      for (int k = 0; k < n_kx; ++k) {
        int const m = k == 0 ? 0 : nx - k;
        Real* const out = spectrum + ((c * static_cast<long>(patch.nodes[2]) + z) * n_kx + k) * 2 * ys + y0;
        store(out, fr[k] + fr[m]);
        store(out + ys, fi[k] - fi[m]);
        if (!pair) continue;
        store(out + W, fi[k] + fi[m]);
        store(out + ys + W, fr[m] - fr[k]);
      }
    }
}

template <class Real>
void GridConvolution<Real>::z_sweep(Patch<Real> const& patch, int component, int kx, bool inverse,
                                    Real* spectrum) const {
  int const nz = patch.nodes[2], n_kx = patch.symbol->modes[0] + 1;
  long const ys = padded_rows(patch.nodes[1], W), stride = 2 * n_kx * ys;
  int const most = partner_modes(patch.symbol->band, kx, patch.nodes[0], nz, patch.symbol->modes[2]);
  auto const& transform = transforms_.at(nz);
  P* const re = scratch<P>(4 * nz);
  P *const im = re + nz, *const work_re = im + nz, *const work_im = work_re + nz;
  long const y_begin = inverse ? patch.target_low[1] / W * W : 0;
  // Whole pairs of vectors, as the x sweep transforms them.
  long const y_end = inverse ? std::min(ys, y_begin + (patch.target_high[1] - y_begin + 2 * W - 1) / (2 * W) * 2 * W) : ys;
  for (long y = y_begin; y < y_end; y += W) {
    Real* const base = spectrum + (static_cast<long>(component) * nz * n_kx + kx) * 2 * ys + y;
    for (int z = 0; z < nz; ++z) {
      bool const kept = !inverse || z <= most || z >= nz - most;
      re[z] = kept ? load(base + z * stride) : P{};
      im[z] = kept ? load(base + z * stride + ys) : P{};
    }
    bool const moved =
        inverse ? transform.forward(im, re, work_im, work_re) : transform.forward(re, im, work_re, work_im);
    P const* const fr = moved ? work_re : re;
    P const* const fi = moved ? work_im : im;
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

template <class Real>
template <class Symbol>
void GridConvolution<Real>::y_sweep(Patch<Real> const& patch, int jz, Real* spectrum) const {
  constexpr int n_in = Symbol::components;
  SymbolTable<Real> const& symbol = *patch.symbol;
  int const ny = patch.nodes[1], nz = patch.nodes[2], n_kx = symbol.modes[0] + 1;
  long const ys = padded_rows(ny, W);
  auto const& transform = transforms_.at(ny);
  P* const lines = scratch<P>((2 * n_in + 2) * ys);
  P *const work_re = lines + 2 * n_in * ys, *const work_im = work_re + ys;
  auto const re = [&](int c) { return lines + 2 * c * ys; };
  auto const im = [&](int c) { return lines + (2 * c + 1) * ys; };
  int const z = jz < 0 ? jz + nz : jz;
  auto const address = [&](int c, int part, int kx, long y) {
    return spectrum + (((static_cast<long>(c) * nz + z) * n_kx + kx) * 2 + part) * ys + y;
  };
  auto const move = [&](P* line, int c, int part, int kx0, bool out) {
    for (long y = 0; y < ys; y += W) {
      P square[W];
      if (out) {
        for (int i = 0; i < W; ++i) square[i] = line[y + i];
        transpose<Real>(square);
        for (int i = 0; i < std::min(W, n_kx - kx0); ++i) store(address(c, part, kx0 + i, y), square[i]);
      } else {
        for (int i = 0; i < W; ++i) square[i] = kx0 + i < n_kx ? load(address(c, part, kx0 + i, y)) : P{};
        transpose<Real>(square);
        for (int i = 0; i < W; ++i) line[y + i] = square[i];
      }
    }
  };
  P lane{};
  for (int i = 0; i < W; ++i) lane[i] = static_cast<Real>(i);
  double const kz = 2.0 * M_PI * jz / nz;
  for (int kx0 = 0; kx0 < n_kx; kx0 += W) {
    if (std::abs(jz) > partner_modes(symbol.band, kx0, patch.nodes[0], nz, symbol.modes[2])) break;
    for (int c = 0; c < n_in; ++c) {
      move(re(c), c, 0, kx0, false);
      move(im(c), c, 1, kx0, false);
      if (transform.forward(re(c), im(c), work_re, work_im)) {
        std::copy_n(work_re, ny, re(c));
        std::copy_n(work_im, ny, im(c));
      }
    }
    P k[3];
    k[0] = (lane + static_cast<Real>(kx0)) * static_cast<Real>(2.0 * M_PI / patch.nodes[0]);
    k[2] = broadcast(static_cast<Real>(kz));
    for (int y = 0; y < ny; ++y) {
      int const jy = y <= ny / 2 ? y : y - ny;
      P u_re[3] = {P{}, P{}, P{}}, u_im[3] = {P{}, P{}, P{}};
      if (std::abs(jy) <= symbol.modes[1]) {
        k[1] = broadcast(static_cast<Real>(2.0 * M_PI * jy / ny));
        long const row = static_cast<long>(std::abs(jz)) * (symbol.modes[1] + 1) + std::abs(jy);
        P f_re[n_in], f_im[n_in];
        for (int c = 0; c < n_in; ++c) f_re[c] = re(c)[y], f_im[c] = im(c)[y];
        Symbol::apply(k, load(symbol.value.data() + row * symbol.stride + kx0), f_re, f_im, u_re, u_im);
      }
      for (int d = 0; d < 3; ++d) re(d)[y] = u_re[d], im(d)[y] = u_im[d];
    }
    for (int d = 0; d < 3; ++d) {
      bool const moved = transform.forward(im(d), re(d), work_im, work_re);
      P *const out_re = moved ? work_re : re(d), *const out_im = moved ? work_im : im(d);
      std::fill(out_re + ny, out_re + ys, P{});  // rows beyond the grid share lanes with rows inside it
      std::fill(out_im + ny, out_im + ys, P{});
      move(out_re, d, 0, kx0, true);
      move(out_im, d, 1, kx0, true);
    }
  }
}

template <class Real>
void GridConvolution<Real>::x_inverse(Patch<Real> const& patch, long z, long row, Real* grid,
                                      Real const* spectrum) const {
  int const nx = patch.nodes[0], ny = patch.nodes[1], n_kx = patch.symbol->modes[0] + 1;
  long const ys = padded_rows(ny, W);
  auto const& transform = transforms_.at(nx);
  long const n_block = (row + W - 1) / W * W;
  P* const re = scratch<P>(4 * n_block);
  P *const im = re + n_block, *const work_re = im + n_block, *const work_im = work_re + n_block;
  for (int c = 0; c < 3; ++c)
    for (long y0 = patch.target_low[1] / W * W; y0 < patch.target_high[1]; y0 += 2 * W) {
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
      bool const moved = transform.forward(im, re, work_im, work_re);
      for (int part = 0; part < 2; ++part) {
        P const* const line = part == 0 ? (moved ? work_re : re) : (moved ? work_im : im);
        for (long x = 0; x < nx; x += W) {
          P square[W];
          for (int i = 0; i < W; ++i) square[i] = line[x + i];
          transpose<Real>(square);
          for (int i = 0; i < W; ++i) {
            long const y = y0 + part * W + i;
            if (y < ny) store(grid + ((z * ny + y) * components_ + c) * row + x, square[i]);
          }
        }
      }
    }
}

template class GridConvolution<float>;
template class GridConvolution<double>;

}  // namespace asterflow

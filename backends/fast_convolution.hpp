#pragma once
// Convolution of a patch's grid with a kernel given in Fourier space, in five sweeps over lines:
//   x forward, z forward, (y forward, symbol, y inverse), z inverse, x inverse.
// Only modes inside the band are kept, so later sweeps are shorter. Real rows are transformed in pairs, as
// real and imaginary part. Vector lanes hold lines that are neighbours in y (x and z sweeps) or kx (y sweep).
//   grid     [z, y, component, x]          real
//   spectrum [component, z, kx, 2, y]      real and imaginary parts as separate rows

#include "backends/fast_fourier.hpp"
#include "backends/fast_patch.hpp"

#include <map>
#include <string_view>

namespace asterflow {

enum class Sweep { x_forward, z_forward, y_and_symbol, z_inverse, x_inverse };

template <class Real>
class GridConvolution {
 public:
  // components: of the strengths (3; stresslet 6: xx yy zz xy xz yz). Results have 3.
  GridConvolution(std::string_view kernel, int components);

  void prepare(int length);  // makes the transform of one length; call before sweeps, not in parallel

  long spectrum_size(Patch<Real> const& patch) const;
  long n_items(Patch<Real> const& patch, Sweep sweep) const;  // independent pieces of one sweep
  void run(Patch<Real> const& patch, Sweep sweep, long item, long row, Real* grid, Real* spectrum) const;

 private:
  using P = Pack<Real>;
  static constexpr int W = lanes<Real>;

  void x_forward(Patch<Real> const& patch, long z, long row, Real const* grid, Real* spectrum) const;
  void x_inverse(Patch<Real> const& patch, long z, long row, Real* grid, Real const* spectrum) const;
  void z_sweep(Patch<Real> const& patch, int component, int kx, bool inverse, Real* spectrum) const;
  template <class Symbol>
  void y_sweep(Patch<Real> const& patch, int kz, Real* spectrum) const;

  std::string_view kernel_;
  int components_;
  std::map<int, LineTransform<Real>> transforms_;
};

// Table of filter(k) / (k^4 n_x n_y n_z) times the corrections for the two uses of the grid window, for wave
// numbers k below `band`; all lengths in units of the grid spacing.
template <class Real, class Filter, class Correction>
SymbolTable<Real> make_symbol(int const (&nodes)[3], double band, Filter const& filter, Correction const& correction);

extern template class GridConvolution<float>;
extern template class GridConvolution<double>;

template <class Real, class Filter, class Correction>
SymbolTable<Real> make_symbol(int const (&nodes)[3], double band, Filter const& filter, Correction const& correction) {
  constexpr int n_lane = lanes<Real>;
  SymbolTable<Real> table;
  table.band = band;
  std::vector<double> by_direction[3];
  for (int d = 0; d < 3; ++d) {
    table.modes[d] = static_cast<int>(band * nodes[d] / (2.0 * M_PI));
    for (int j = 0; j <= table.modes[d]; ++j) {
      double const window = correction(2.0 * M_PI * j / nodes[d]);
      by_direction[d].push_back(1.0 / (nodes[d] * window * window));
    }
  }
  table.stride = (table.modes[0] + n_lane) / n_lane * n_lane;
  table.value.assign(static_cast<std::size_t>(table.modes[2] + 1) * (table.modes[1] + 1) * table.stride, Real(0));
  for (int jz = 0; jz <= table.modes[2]; ++jz)
    for (int jy = 0; jy <= table.modes[1]; ++jy)
      for (int jx = 0; jx <= table.modes[0]; ++jx) {
        double const kx = 2.0 * M_PI * jx / nodes[0], ky = 2.0 * M_PI * jy / nodes[1], kz = 2.0 * M_PI * jz / nodes[2];
        double const k2 = kx * kx + ky * ky + kz * kz;
        if (k2 == 0.0 || k2 > band * band) continue;
        double const s = filter(std::sqrt(k2)) / (k2 * k2) * by_direction[0][jx] * by_direction[1][jy] * by_direction[2][jz];
        // Rows are transformed in pairs; their separation leaves a factor 2.
        table.value[(static_cast<std::size_t>(jz) * (table.modes[1] + 1) + jy) * table.stride + jx] = static_cast<Real>(0.5 * s);
      }
  return table;
}

}  // namespace asterflow

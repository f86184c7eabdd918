#include "backends/fast_spectrum.hpp"

#include "base/parallel.hpp"

#include <cmath>

namespace asterflow {

template <class Real>
SymbolTable<Real> make_symbol(int const (&nodes)[3], double band, int lanes, std::function<double(double)> const& filter,
                              std::function<double(double)> const& correction) {
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
  table.stride = (table.modes[0] + lanes) / lanes * lanes;
  table.value.assign(static_cast<std::size_t>(table.modes[2] + 1) * (table.modes[1] + 1) * table.stride, Real(0));
  parallel_for("Fast::make_symbol", table.modes[2] + 1, [&](long jz) {
    double const kz = 2.0 * M_PI * static_cast<double>(jz) / nodes[2];
    for (int jy = 0; jy <= table.modes[1]; ++jy)
      for (int jx = 0; jx <= table.modes[0]; ++jx) {
        double const kx = 2.0 * M_PI * jx / nodes[0], ky = 2.0 * M_PI * jy / nodes[1];
        double const k2 = kx * kx + ky * ky + kz * kz;
        if (k2 == 0.0 || k2 > band * band) continue;
        double const s = filter(std::sqrt(k2)) / (k2 * k2) * by_direction[0][jx] * by_direction[1][jy] * by_direction[2][jz];
        // Rows are transformed in pairs; their separation leaves a factor 2.
        table.value[(static_cast<std::size_t>(jz) * (table.modes[1] + 1) + jy) * table.stride + jx] = static_cast<Real>(0.5 * s);
      }
  });
  return table;
}

template SymbolTable<float> make_symbol(int const (&)[3], double, int, std::function<double(double)> const&,
                                        std::function<double(double)> const&);
template SymbolTable<double> make_symbol(int const (&)[3], double, int, std::function<double(double)> const&,
                                         std::function<double(double)> const&);

}  // namespace asterflow

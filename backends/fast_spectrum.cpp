#include "backends/fast_spectrum.hpp"

#include "base/parallel.hpp"

#include <array>
#include <cmath>
#include <utility>

namespace asterflow {
namespace {

using Mode = std::array<int, 3>;

// The mode that stands for all that differ from j by the order of directions with as many nodes.
Mode like(Mode j, int const (&nodes)[3]) {
  auto const sort = [&](int a, int b) {
    if (nodes[a] == nodes[b] && j[a] > j[b]) std::swap(j[a], j[b]);
  };
  sort(0, 1), sort(1, 2), sort(0, 1), sort(0, 2);
  return j;
}

template <class Body>
void for_modes(int const (&modes)[3], int jz, Body const& body) {
  for (int jy = 0; jy <= modes[1]; ++jy)
    for (int jx = 0; jx <= modes[0]; ++jx) body(Mode{jx, jy, jz});
}

}  // namespace

template <class Real>
SymbolTable<Real> make_symbol(int const (&nodes)[3], double band, int lanes, std::function<double(double)> const& filter,
                              std::function<double(double)> const& correction) {
  SymbolTable<Real> table;
  table.band = band;
  std::vector<double> by_direction[3];
  for (int d = 0; d < 3; ++d) {
    // Below the band, not on it: the sweeps compare wave numbers with it too, each with its own rounding.
    table.modes[d] = static_cast<int>((1.0 - 1e-12) * band * nodes[d] / (2.0 * M_PI));
    for (int j = 0; j <= table.modes[d]; ++j) {
      double const window = correction(2.0 * M_PI * j / nodes[d]);
      by_direction[d].push_back(1.0 / (nodes[d] * window * window));
    }
  }
  table.stride = (table.modes[0] + lanes) / lanes * lanes;
  table.value.assign(static_cast<std::size_t>(table.modes[2] + 1) * (table.modes[1] + 1) * table.stride, Real(0));
  auto const at = [&](Mode const& j) -> Real& {
    return table.value[(static_cast<std::size_t>(j[2]) * (table.modes[1] + 1) + j[1]) * table.stride + j[0]];
  };
  parallel_for("Fast::make_symbol", table.modes[2] + 1, [&](long jz) {
    for_modes(table.modes, static_cast<int>(jz), [&](Mode const& j) {
      if (j != like(j, nodes)) return;
      double k2 = 0.0;
      for (int d = 0; d < 3; ++d) k2 += std::pow(2.0 * M_PI * j[d] / nodes[d], 2);
      if (k2 == 0.0 || k2 > band * band) return;
      double const s = filter(std::sqrt(k2)) / (k2 * k2) * by_direction[0][j[0]] * by_direction[1][j[1]] * by_direction[2][j[2]];
      at(j) = static_cast<Real>(0.5 * s);  // rows are transformed in pairs; their separation leaves a factor 2
    });
  });
  parallel_for("Fast::copy_symbol", table.modes[2] + 1, [&](long jz) {
    for_modes(table.modes, static_cast<int>(jz), [&](Mode const& j) {
      Mode const computed = like(j, nodes);
      if (j != computed) at(j) = at(computed);
    });
  });
  return table;
}

template SymbolTable<float> make_symbol(int const (&)[3], double, int, std::function<double(double)> const&,
                                        std::function<double(double)> const&);
template SymbolTable<double> make_symbol(int const (&)[3], double, int, std::function<double(double)> const&,
                                         std::function<double(double)> const&);

}  // namespace asterflow

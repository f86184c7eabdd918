#include "backends/fast_spectrum.hpp"

#include "base/parallel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace asterflow {
namespace {

using Mode = std::array<int, 3>;

// The mode that stands for all that differ from j by the order of directions with as many nodes.
Mode like(Mode j, int const (&nodes)[3]) {
  auto const sort = [&](int a, int b) {
    if (nodes[a] == nodes[b] && j[a] < j[b]) std::swap(j[a], j[b]);
  };
  sort(0, 1), sort(1, 2), sort(0, 1), sort(0, 2);
  return j;
}

}  // namespace

template <class Real>
SymbolTable<Real> make_symbol(int const (&nodes)[3], double band, int lanes, std::function<double(double)> const& filter,
                              std::function<double(double)> const& correction) {
  SymbolTable<Real> table;
  table.band = band;
  std::vector<double> by_direction[3], squares[3];  // of wave numbers
  for (int d = 0; d < 3; ++d) {
    // Below the band, not on it: the sweeps compare wave numbers with it too, each with its own rounding.
    table.modes[d] = static_cast<int>((1.0 - 1e-12) * band * nodes[d] / (2.0 * M_PI));
    for (int j = 0; j <= table.modes[d]; ++j) {
      double const k = 2.0 * M_PI * j / nodes[d], window = correction(k);
      squares[d].push_back(k * k);
      by_direction[d].push_back(1.0 / (nodes[d] * window * window));
    }
  }
  table.stride = (table.modes[2] + lanes) / lanes * lanes;
  table.value.assign(static_cast<std::size_t>(table.modes[0] + 1) * (table.modes[1] + 1) * table.stride, Real(0));
  auto const row = [&](int jx, int jy) { return table.value.data() + (static_cast<std::size_t>(jx) * (table.modes[1] + 1) + jy) * table.stride; };
  // Modes that stand for others have descending numbers in directions with as many nodes.
  auto const last_y = [&](int jx) { return nodes[0] == nodes[1] ? jx : table.modes[1]; };
  auto const last_z = [&](int jx, int jy) { return nodes[1] == nodes[2] ? jy : nodes[0] == nodes[2] ? std::min(jx, table.modes[2]) : table.modes[2]; };
  parallel_for("Fast::make_symbol", table.modes[0] + 1, [&](long x) {
    int const jx = static_cast<int>(x);
    for (int jy = 0; jy <= last_y(jx); ++jy)
      for (int jz = 0; jz <= last_z(jx, jy); ++jz) {
        double const k2 = squares[0][jx] + squares[1][jy] + squares[2][jz];
        if (k2 > band * band) break;
        if (k2 == 0.0) continue;
        double const s = filter(std::sqrt(k2)) / (k2 * k2) * by_direction[0][jx] * by_direction[1][jy] * by_direction[2][jz];
        row(jx, jy)[jz] = static_cast<Real>(0.5 * s);  // rows are transformed in pairs; their separation leaves a factor 2
      }
  });
  parallel_for("Fast::mirror_symbol_z", table.modes[0] + 1, [&](long x) {
    int const jx = static_cast<int>(x);
    for (int jy = 0; jy <= last_y(jx); ++jy)
      for (int jz = last_z(jx, jy) + 1; jz <= table.modes[2]; ++jz) {
        if (squares[0][jx] + squares[1][jy] + squares[2][jz] > band * band) break;
        Mode const j = like({jx, jy, jz}, nodes);
        row(jx, jy)[jz] = row(j[0], j[1])[j[2]];
      }
  });
  if (nodes[0] == nodes[1])
    parallel_for("Fast::mirror_symbol_y", table.modes[0] + 1, [&](long x) {
      int const jx = static_cast<int>(x);
      for (int jy = jx + 1; jy <= table.modes[1]; ++jy) std::copy_n(row(jy, jx), table.stride, row(jx, jy));
    });
  return table;
}

template SymbolTable<float> make_symbol(int const (&)[3], double, int, std::function<double(double)> const&,
                                        std::function<double(double)> const&);
template SymbolTable<double> make_symbol(int const (&)[3], double, int, std::function<double(double)> const&,
                                         std::function<double(double)> const&);

}  // namespace asterflow

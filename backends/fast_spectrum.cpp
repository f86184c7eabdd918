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
    if (nodes[a] == nodes[b] && j[a] > j[b]) std::swap(j[a], j[b]);
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
  table.stride = (table.modes[0] + lanes) / lanes * lanes;
  table.value.assign(static_cast<std::size_t>(table.modes[2] + 1) * (table.modes[1] + 1) * table.stride, Real(0));
  auto const row = [&](int jy, int jz) { return table.value.data() + (static_cast<std::size_t>(jz) * (table.modes[1] + 1) + jy) * table.stride; };
  // Modes that stand for others have ascending numbers in directions with as many nodes.
  auto const last_y = [&](int jz) { return nodes[1] == nodes[2] ? jz : table.modes[1]; };
  auto const last_x = [&](int jy, int jz) { return nodes[0] == nodes[1] ? jy : nodes[0] == nodes[2] ? std::min(jz, table.modes[0]) : table.modes[0]; };
  parallel_for("Fast::make_symbol", table.modes[2] + 1, [&](long z) {
    int const jz = static_cast<int>(z);
    for (int jy = 0; jy <= last_y(jz); ++jy)
      for (int jx = 0; jx <= last_x(jy, jz); ++jx) {
        double const k2 = squares[0][jx] + squares[1][jy] + squares[2][jz];
        if (k2 > band * band) break;
        if (k2 == 0.0) continue;
        double const s = filter(std::sqrt(k2)) / (k2 * k2) * by_direction[0][jx] * by_direction[1][jy] * by_direction[2][jz];
        row(jy, jz)[jx] = static_cast<Real>(0.5 * s);  // rows are transformed in pairs; their separation leaves a factor 2
      }
  });
  parallel_for("Fast::mirror_symbol_x", table.modes[2] + 1, [&](long z) {
    int const jz = static_cast<int>(z);
    for (int jy = 0; jy <= last_y(jz); ++jy)
      for (int jx = last_x(jy, jz) + 1; jx <= table.modes[0]; ++jx) {
        if (squares[0][jx] + squares[1][jy] + squares[2][jz] > band * band) break;
        Mode const j = like({jx, jy, jz}, nodes);
        row(jy, jz)[jx] = row(j[1], j[2])[j[0]];
      }
  });
  if (nodes[1] == nodes[2])
    parallel_for("Fast::mirror_symbol_y", table.modes[2] + 1, [&](long z) {
      int const jz = static_cast<int>(z);
      for (int jy = jz + 1; jy <= table.modes[1]; ++jy) std::copy_n(row(jz, jy), table.stride, row(jy, jz));
    });
  return table;
}

template SymbolTable<float> make_symbol(int const (&)[3], double, int, std::function<double(double)> const&,
                                        std::function<double(double)> const&);
template SymbolTable<double> make_symbol(int const (&)[3], double, int, std::function<double(double)> const&,
                                         std::function<double(double)> const&);

}  // namespace asterflow

// Which rows of a patch's spectrum there are, and where they lie. Only modes inside the band are kept, so later sweeps are
// shorter; lines that no source reaches are not transformed forward, those without targets not back.

namespace asterflow {
namespace {

constexpr double two_pi = 6.283185307179586;

// Largest |j2| such that (j1, j2) is inside the band, -1 if there is none. Modes on the band are left out, so that rounding
// decides alike wherever this is compiled into.
inline int partner_modes(double band, int j1, int n1, int n2, int most) {
  double const k1 = two_pi * j1 / n1;
  double const rest = band * band - k1 * k1;
  constexpr double below = 1.0 - 1e-12;
  return rest < 0.0 ? -1 : smaller(most, static_cast<int>(below * std::sqrt(rest) * n2 / two_pi));
}

// Rows of the spectrum, from used_low[1]: whole pairs of vectors, as the x sweeps transform them.
struct Rows {
  long begin, end;
};

// Those of nodes low ... high - 1; pairs begin at multiples of `unit`.
template <class Real>
Rows rows(PatchView<Real> const& patch, int low, int high, long unit) {
  constexpr long pair = 2 * lanes<Real>;
  if (low >= high) return {0, 0};
  long const begin = (low - patch.used_low[1]) / unit * unit;
  return {begin, smaller(patch.spectrum_row, begin + (high - patch.used_low[1] - begin + pair - 1) / pair * pair)};
}
template <class Real>
Rows source_rows(PatchView<Real> const& patch) {
  return rows(patch, patch.source_low[1], patch.source_high[1], 2 * lanes<Real>);
}
template <class Real>
Rows target_rows(PatchView<Real> const& patch) {
  return rows(patch, patch.target_low[1], patch.target_high[1], lanes<Real>);
}

// Where rows of mode kx of one plane lie in the spectrum; a row of imaginary parts follows.
template <class Real>
long spectrum_line(PatchView<Real> const& patch, int component, int plane, int kx) {
  return ((static_cast<long>(component) * patch.planes + plane) * (patch.modes[0] + 1) + kx) * 2 * patch.spectrum_row;
}

// Numbers of a line along y in scratch: whole vectors of rows may end beyond its last node.
template <class Real>
long y_room(PatchView<Real> const& patch) {
  return (patch.nodes[1] + lanes<Real> - 1) / lanes<Real> * lanes<Real> + lanes<Real>;
}

}  // namespace
}  // namespace asterflow

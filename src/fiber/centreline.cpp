#include "fiber/centreline.hpp"

#include "base/error.hpp"
#include "fiber/fiber_basis.hpp"

#include <algorithm>
#include <array>

namespace asterflow {

namespace {

constexpr int max_tangents = max_fiber_nodes - max_fiber_nodes / 4;

// A basis with as many tangent nodes. (Two neighbouring node counts may share it; what is used here is the same.)
FiberBasis const& basis_of(Centreline const& centreline) {
  int const m = static_cast<int>(centreline.tangents.size());
  return fiber_basis(m + (m - 1) / 3);
}

// Legendre coefficients of the tangent and, for unit length, of its integral from the minus end.
struct Series {
  int n_tangent;
  std::array<Vec3d, max_tangents + 1> tangent, position;
};

Series series_of(Centreline const& c) {
  FiberBasis const& basis = basis_of(c);
  Series series{basis.n_tangent, {}, {}};
  int const m = basis.n_tangent;
  for (int j = 0; j < m; ++j)
    for (int k = 0; k < m; ++k) series.tangent[k] += basis.transform(k, j) * c.tangents[j];
  // Integral of P_k from 0 to alpha: (P_{k+1} - P_{k-1}) / (2 (2k+1)); of P_0: (P_1 + P_0) / 2.
  series.position[0] += 0.5 * series.tangent[0];
  series.position[1] += 0.5 * series.tangent[0];
  for (int k = 1; k < m; ++k) {
    Vec3d const part = (0.5 / (2 * k + 1)) * series.tangent[k];
    series.position[k + 1] += part;
    series.position[k - 1] -= part;
  }
  return series;
}

}  // namespace

Centreline straight_centreline(Vec3d minus_end, Vec3d direction, double length, int n_node) {
  return {minus_end, length, PointArray(fiber_basis(n_node).n_tangent, normalized(direction))};
}

Vec3d plus_end(Centreline const& c) {
  auto const& weights = basis_of(c).lobatto.weights;
  Vec3d sum;
  for (std::size_t j = 0; j < c.tangents.size(); ++j) sum += weights[j] * c.tangents[j];
  return c.minus_end + c.length * sum;
}

double squared_curvature(Centreline const& c) {
  auto const& bending = basis_of(c).bending;
  double sum = 0.0;  // rows of `bending` sum to zero: differences lose nothing of a small curvature
  for (std::size_t i = 0; i < c.tangents.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      Vec3d const change = c.tangents[i] - c.tangents[j];
      sum -= bending(i, j) * dot(change, change);
    }
  return sum / c.length;
}

void sample(Centreline const& c, ConstVector s, Points positions, Points tangents) {
  Series const series = series_of(c);
  for (std::size_t i = 0; i < s.size(); ++i) {
    double const inside = std::min(s[i], c.length), beyond = s[i] - inside;
    double const x = 2 * inside / c.length - 1;
    double before = 0.0, p = 1.0;
    Vec3d tangent, position;
    for (int k = 0; k <= series.n_tangent; ++k) {
      tangent += p * series.tangent[k];
      position += p * series.position[k];
      double const next = ((2 * k + 1) * x * p - k * before) / (k + 1);
      before = p;
      p = next;
    }
    if (!positions.empty()) positions[i] = c.minus_end + c.length * position + beyond * tangent;
    if (!tangents.empty()) tangents[i] = tangent;
  }
}

}  // namespace asterflow

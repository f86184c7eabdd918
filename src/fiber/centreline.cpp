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
  constexpr std::size_t block = 16;  // points at a time, one Legendre recurrence for all of them
  for (std::size_t first = 0; first < s.size(); first += block) {
    std::size_t const n = std::min(block, s.size() - first);
    std::array<double, block> x{}, before{}, p, beyond{};
    std::array<std::array<double, block>, 3> tangent{}, position{};
    p.fill(1.0);
    for (std::size_t i = 0; i < n; ++i) {
      double const inside = std::min(s[first + i], c.length);
      beyond[i] = s[first + i] - inside;
      x[i] = 2 * inside / c.length - 1;
    }
    for (int k = 0; k <= series.n_tangent; ++k) {
      Vec3d const t = series.tangent[k], q = series.position[k];
      double const forward = (2 * k + 1.0) / (k + 1), backward = double(k) / (k + 1);
      for (std::size_t i = 0; i < block; ++i) {
        for (int j = 0; j < 3; ++j) {
          tangent[j][i] += p[i] * t[j];
          position[j][i] += p[i] * q[j];
        }
        double const next = forward * x[i] * p[i] - backward * before[i];
        before[i] = p[i];
        p[i] = next;
      }
    }
    for (std::size_t i = 0; i < n; ++i) {
      Vec3d const t{tangent[0][i], tangent[1][i], tangent[2][i]}, q{position[0][i], position[1][i], position[2][i]};
      if (!positions.empty()) positions[first + i] = c.minus_end + c.length * q + beyond[i] * t;
      if (!tangents.empty()) tangents[first + i] = t;
    }
  }
}

}  // namespace asterflow

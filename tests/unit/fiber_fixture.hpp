#pragma once
// Fibers in a given flow that they do not disturb (level `local`), for tests.

#include "fiber/fibers.hpp"

#include <cmath>
#include <functional>
#include <numbers>

namespace asterflow::test {

using Flow = std::function<Vec3d(Vec3d)>;  // um/s at um

inline Vec3d no_flow(Vec3d) { return {}; }

// One step of free fibers and fibers held in space. Returns the error estimate, um.
inline double step(Fibers& fibers, double dt, Flow const& flow = no_flow) {
  fibers.prepare(dt, {});
  PointArray u;
  for (Vec3d x : fibers.nodes()) u.push_back(flow(x));
  fibers.advance(u, {}, {});
  double const error = fibers.error_estimate();
  fibers.accept();
  return error;
}

// Free-free (4.7300) or clamped-free (1.8751) bending mode: deflection and slope at alpha = s / L, with k = K / L.
struct BendingMode {
  double k, sigma;
  bool is_clamped;
  static BendingMode free_free() {
    double const k = 4.730040744862704;
    return {k, (std::cosh(k) - std::cos(k)) / (std::sinh(k) - std::sin(k)), false};
  }
  static BendingMode clamped_free() {
    double const k = 1.8751040687119611;
    return {k, (std::cosh(k) + std::cos(k)) / (std::sinh(k) + std::sin(k)), true};
  }
  double slope(double alpha) const {  // d deflection / d alpha
    double const x = k * alpha, sign = is_clamped ? -1.0 : 1.0;
    return k * (std::sinh(x) - sign * std::sin(x) - sigma * (std::cosh(x) + sign * std::cos(x)));
  }
};

// A fiber along x whose slope in y is amplitude * slope(alpha).
template <class Slope>
Centreline bent_centreline(double length, int n_node, double amplitude, Slope const& slope) {
  Centreline c = straight_centreline({}, {1, 0, 0}, length, n_node);
  FiberBasis const& basis = fiber_basis(n_node);
  for (int j = 0; j < basis.n_tangent; ++j)
    c.tangents[j] = normalized(Vec3d{1.0, amplitude * slope(basis.lobatto.nodes[j]), 0.0});
  return c;
}

}  // namespace asterflow::test

// Finite part of slender-body theory: its spectrum on a straight fiber, an independent quadrature on a curved one, and
// the exact drag of a spheroid.

#include "fiber/own_flow.hpp"

#include "fiber/centreline.hpp"
#include "fiber/fibers.hpp"
#include "fiber_fixture.hpp"

#include <gtest/gtest.h>

using namespace asterflow;

namespace {

constexpr double pi = std::numbers::pi;

PointArray nodes_of(Centreline const& shape, int n_node) {
  std::vector<double> s;
  for (double const alpha : fiber_basis(n_node).gauss.nodes) s.push_back(alpha * shape.length);
  PointArray nodes(s.size());
  sample(shape, s, nodes, {});
  return nodes;
}

PointArray own_flow(Centreline const& shape, double radius, double viscosity, PointArray const& f) {
  auto const n = static_cast<int>(f.size());
  OwnFlow flow;
  flow.prepare(fiber_basis(n), shape, nodes_of(shape, n), slender_body_mobility(shape.length, radius, viscosity), viscosity);
  PointArray u(f.size());
  flow.add(f, u);
  return u;
}

}  // namespace

TEST(OwnFlow, of_a_straight_fiber_is_diagonal_on_Legendre_polynomials) {
  int const n = 12;
  double const viscosity = 0.7;
  Centreline const shape = straight_centreline({1, 2, 3}, {1, 0, 0}, 4.0, n);
  Eigen::MatrixXd const values = legendre_values(fiber_basis(n).gauss.nodes, n);
  double harmonic = 0.0;
  for (int k = 0; k < n; ++k) {
    if (k > 0) harmonic += 1.0 / k;
    PointArray f(n);
    for (int i = 0; i < n; ++i) f[i] = values(i, k) * Vec3d{1.0, 2.0, 0.0};
    PointArray const u = own_flow(shape, 4e-4, viscosity, f);
    for (int i = 0; i < n; ++i) {  // along: 2 (- 2 H_k); across: 2 - 2 H_k
      EXPECT_NEAR(u[i].x * 8.0 * pi * viscosity, -4.0 * harmonic * f[i].x, 1e-11);
      EXPECT_NEAR(u[i].y * 8.0 * pi * viscosity, (2.0 - 2.0 * harmonic) * f[i].y, 1e-11);
    }
  }
}

TEST(OwnFlow, of_a_curved_fiber_agrees_with_an_independent_quadrature) {
  int const n = 24;
  double const radius_of_arc = 3.0, length = 6.0, viscosity = 1.3;
  Centreline shape = straight_centreline({}, {1, 0, 0}, length, n);
  FiberBasis const& basis = fiber_basis(n);
  auto const tangent = [&](double s) { return Vec3d{std::cos(s / radius_of_arc), std::sin(s / radius_of_arc), 0.0}; };
  auto const place = [&](double s) {
    return Vec3d{radius_of_arc * std::sin(s / radius_of_arc), radius_of_arc * (1.0 - std::cos(s / radius_of_arc)), 0.0};
  };
  auto const density = [&](double s) { return Vec3d{std::cos(0.8 * s), 1.0 - 0.2 * s, std::exp(-0.3 * s)}; };
  for (int j = 0; j < basis.n_tangent; ++j) shape.tangents[j] = tangent(length * basis.lobatto.nodes[j]);
  PointArray f(n);
  for (int i = 0; i < n; ++i) f[i] = density(length * basis.gauss.nodes[i]);
  PointArray const u = own_flow(shape, 1e-4, viscosity, f);
  UnitRule const rule = gauss_rule(60);
  for (int i = 0; i < n; ++i) {
    double const s = length * basis.gauss.nodes[i];
    Vec3d const t = tangent(s), f_s = density(s), along = f_s + dot(t, f_s) * t;
    Vec3d sum = 2.0 * (f_s - dot(t, f_s) * t);
    for (auto const& [begin, end] : {std::pair{0.0, s}, std::pair{s, length}})  // smooth on each side of s
      for (int k = 0; k < 60; ++k) {
        double const at = begin + (end - begin) * rule.nodes[k];
        Vec3d const r = place(s) - place(at), g = density(at);
        double const d = norm(r);
        sum += (end - begin) * rule.weights[k] *
               (1.0 / d * g + (dot(r, g) / (d * d * d)) * r - 1.0 / std::abs(s - at) * along);
      }
    EXPECT_LT(norm(8.0 * pi * viscosity * u[i] - sum), 1e-9 * 60.0);  // cancellation of 1/d at the closest points
  }
}

TEST(OwnFlow, never_moves_a_fiber_against_its_force) {
  int const n = 30;
  Centreline const shape = straight_centreline({}, {0, 0, 1}, 0.5, n);
  double const mobility = slender_body_mobility(0.5, 0.05, 1.0);  // eps = 0.1: 2 H_k exceeds ln(eps^-2 e^-1) from k = 4
  Eigen::MatrixXd const values = legendre_values(fiber_basis(n).gauss.nodes, n);
  for (int k = 0; k < n; ++k) {
    PointArray f(n);
    for (int i = 0; i < n; ++i) f[i] = values(i, k) * Vec3d{1.0, 0.0, 1.0};
    PointArray const u = own_flow(shape, 0.05, 1.0, f);
    double power = 0.0;
    for (int i = 0; i < n; ++i)
      power += fiber_basis(n).gauss.weights[i] * (dot(f[i], u[i]) + mobility * (dot(f[i], f[i]) + f[i].z * f[i].z));
    EXPECT_GT(power, 0.0) << k;
  }
}

// [Chwang & Wu 1975]: a prolate spheroid of eccentricity e and half length a, L = ln((1 + e) / (1 - e)):
//   along   16 pi mu a e^3 / ((1 + e^2) L - 2 e),   across  32 pi mu a e^3 / (2 e + (3 e^2 - 1) L)
TEST(OwnFlow, gives_a_sinking_fiber_the_speed_of_a_spheroid) {
  double const length = 4.0, radius = 0.04, viscosity = 1.7, a = 0.5 * length, e = std::sqrt(1.0 - radius * radius / (a * a));
  double const logarithm = std::log((1.0 + e) / (1.0 - e));
  double const along = 16.0 * pi * viscosity * a * e * e * e / ((1.0 + e * e) * logarithm - 2.0 * e);
  double const across = 32.0 * pi * viscosity * a * e * e * e / (2.0 * e + (3.0 * e * e - 1.0) * logarithm);
  for (bool const is_along : {true, false}) {
    Fibers fibers(viscosity);
    FiberProperties properties{.radius = radius, .n_node = 12, .is_nonlocal = true};
    properties.load.external = is_along ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
    fibers.add(properties, {}, straight_centreline({}, {1, 0, 0}, length, 12));
    fibers.begin_step();
    fibers.prepare(0.1, {});
    PointArray f(12), u(12);
    for (int iteration = 0; iteration < 100; ++iteration) {
      std::ranges::fill(f, Vec3d{});
      fibers.add_affine_response(f, {});
      fibers.add_linear_response(u, {}, f, {});
      std::ranges::fill(u, Vec3d{});
      fibers.add_own_flow(f, u);
    }
    fibers.advance(u, {}, {});
    fibers.accept();
    Vec3d const moved = fibers.shape(0).minus_end;
    // slender-body theory: eps^2 ln eps with eps = radius / length: 5e-4
    EXPECT_NEAR((is_along ? moved.x : moved.y) / 0.1, length / (is_along ? along : across), 5e-4 * length / along);
  }
}

#include "surface/modal_rows.hpp"

#include "linalg/quadrature.hpp"
#include "surface/graded_rule.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace asterflow {
namespace {

using Eigen::MatrixXd;
constexpr double pi = std::numbers::pi;

// The nine entries (out, in) of the kernel: those even in phi meet cos(m phi), the odd ones sin(m phi).
constexpr int n_even = 5, n_odd = 4;
constexpr int even_out[n_even] = {0, 0, 1, 1, 2}, even_in[n_even] = {0, 1, 0, 1, 2};
constexpr int odd_out[n_odd] = {0, 1, 2, 2}, odd_in[n_odd] = {2, 2, 0, 1};
constexpr double odd_sign[n_odd] = {-1, -1, 1, 1};  // from the factors i of the azimuthal components

// Radial and azimuthal components of a smooth field have the parity of mode m + 1.
bool is_odd_in_t(int component, int m) { return ((component > 0) + m) % 2 != 0; }

// Kernel entries on one ring (position and area vector at phi = 0), times weights: even [n_even, n], odd [n_odd, n].
void ring_kernel(CylindricalPoint x, Vec3d y, Vec3d area, std::vector<RulePoint> const& rule, double weight,
                 MatrixXd& even, MatrixXd& odd) {
  auto const n = static_cast<Eigen::Index>(rule.size());
  even.resize(n, n_even);
  odd.resize(n, n_odd);
  double const z = y.x, r = y.y;
  for (Eigen::Index k = 0; k < n; ++k) {
    // 1 - cos phi without cancellation keeps the small separations exact.
    double const half = std::sin(0.5 * rule[k].x), versine = 2.0 * half * half, sine = std::sin(rule[k].x);
    double const dz = x.z - z, dr = x.r - r;
    double const in[3] = {dz, dr - x.r * versine, -x.r * sine};  // separation . (e_1, e_r(phi), e_phi(phi))
    double const out[3] = {dz, dr + r * versine, -r * sine};     // separation . (e_1, e_r(0), e_phi(0))
    double const square = dz * dz + dr * dr + 2.0 * r * x.r * versine;
    double const inverse = 1.0 / square;
    double const factor = -3.0 / (4.0 * pi) * weight * rule[k].weight * (area.x * in[0] + area.y * in[1]) * inverse *
                          inverse * std::sqrt(inverse);
    for (int e = 0; e < n_even; ++e) even(k, e) = factor * out[even_out[e]] * in[even_in[e]];
    for (int o = 0; o < n_odd; ++o) odd(k, o) = factor * odd_sign[o] * out[odd_out[o]] * in[odd_in[o]];
  }
}

// cos(m phi), sin(m phi): [n, n_mode] each
void harmonics(std::vector<RulePoint> const& rule, int n_mode, MatrixXd& cosines, MatrixXd& sines) {
  auto const n = static_cast<Eigen::Index>(rule.size());
  cosines.resize(n, n_mode);
  sines.resize(n, n_mode);
  for (Eigen::Index k = 0; k < n; ++k) {
    double const c = std::cos(rule[k].x), s = std::sin(rule[k].x);
    double a = 1.0, b = 0.0;
    for (int m = 0; m < n_mode; ++m) {
      cosines(k, m) = a;
      sines(k, m) = b;
      double const next = a * c - b * s;
      b = a * s + b * c;
      a = next;
    }
  }
}

}  // namespace

ModalRows::ModalRows(Surface const& surface, double digits)
    : surface_(surface), n_mode_(surface.grid().n_mode()), n_ring_(surface.grid().n_ring()), digits_(digits) {
  auto const& grid = surface.grid();
  nodes_to_legendre_.resize(n_ring_, n_ring_);
  std::vector<double> values(n_ring_);
  for (int j = 0; j < n_ring_; ++j) {
    double const t = grid.polar_angles()[j];
    sin_t_.push_back(std::sin(t));
    legendre_polynomials(std::cos(t), n_ring_ - 1, values.data());
    for (int l = 0; l < n_ring_; ++l) nodes_to_legendre_(l, j) = grid.ring_weights()[j] * (l + 0.5) * values[l];
  }
}

ModalRowSet ModalRows::at(CylindricalPoint target) const {
  ClosestAngles const closest = surface_.closest_angles(surface_.from_polar({target.z, target.r, 0.0}));
  return integrate(target, {closest.t, std::abs(closest.distance), closest.distance < 0 ? 1.0 : 0.0});
}

ModalRowSet ModalRows::on_surface(double t) const {
  Vec3d const x = surface_.to_polar(surface_.patch(t, 0.0).position);
  return integrate({x.x, x.y}, {t, 0.0, 0.5});
}

ModalRowSet ModalRows::integrate(CylindricalPoint target, Singularity const& near) const {
  double const stretch = norm(surface_.patch(near.t, 0.0).tangent_t);
  std::vector<RulePoint> meridian, azimuth;
  append_graded_rule(0.0, near.t, pi, near.distance / stretch, {digits_, n_ring_ + 1.0}, meridian);

  auto const n_t = static_cast<Eigen::Index>(meridian.size());
  MatrixXd modal_even(n_t, n_even * n_mode_), modal_odd(n_t, n_odd * n_mode_), even, odd, cosines, sines;
  MatrixXd legendre(n_t, n_ring_);
  Eigen::VectorXd sine(n_t);
  std::vector<double> values(n_ring_);
  int trapezoid_size = -1;  // harmonics of the last trapezoid rule are kept
  for (Eigen::Index s = 0; s < n_t; ++s) {
    SurfacePatch const patch = surface_.patch(meridian[s].x, 0.0);
    Vec3d const y = surface_.to_polar(patch.position), area = surface_.to_polar(patch.area_vector());
    double const gap = std::hypot(target.z - y.x, target.r - y.y), product = target.r * y.y;
    double const delta = product > 0.0 ? 2.0 * std::asinh(0.5 * gap / std::sqrt(product)) : 10.0;
    half_period_rule(std::min(delta, 10.0), {digits_, n_mode_ + 1.0}, azimuth);
    if (delta <= 0.3 || static_cast<int>(azimuth.size()) != trapezoid_size) harmonics(azimuth, n_mode_, cosines, sines);
    trapezoid_size = delta > 0.3 ? static_cast<int>(azimuth.size()) : -1;
    ring_kernel(target, y, area, azimuth, meridian[s].weight, even, odd);
    MatrixXd const e = cosines.transpose() * even, o = sines.transpose() * odd;
    for (int c = 0; c < n_even; ++c) modal_even.row(s).segment(c * n_mode_, n_mode_) = e.col(c);
    for (int c = 0; c < n_odd; ++c) modal_odd.row(s).segment(c * n_mode_, n_mode_) = o.col(c);
    legendre_polynomials(std::cos(meridian[s].x), n_ring_ - 1, values.data());
    for (int l = 0; l < n_ring_; ++l) legendre(s, l) = values[l];
    sine[s] = std::sin(meridian[s].x);
  }

  MatrixXd const to_even = legendre * nodes_to_legendre_;
  MatrixXd to_odd = sine.asDiagonal() * to_even;
  for (int j = 0; j < n_ring_; ++j) to_odd.col(j) /= sin_t_[j];
  ModalRowSet rows(n_mode_, Eigen::Matrix<double, 3, Eigen::Dynamic>(3, 3 * n_ring_));
  auto const project = [&](MatrixXd const& modal, int count, int const* out, int const* in) {
    MatrixXd const by_even = modal.transpose() * to_even, by_odd = modal.transpose() * to_odd;
    for (int c = 0; c < count; ++c)
      for (int m = 0; m < n_mode_; ++m)
        rows[m].row(out[c]).segment(in[c] * n_ring_, n_ring_) =
            (is_odd_in_t(in[c], m) ? by_odd : by_even).row(c * n_mode_ + m);
  };
  project(modal_even, n_even, even_out, even_in);
  project(modal_odd, n_odd, odd_out, odd_in);
  remove_constant_defect(near, rows);
  return rows;
}

void ModalRows::interpolation_values(double t, double* even, double* odd) const {
  Eigen::VectorXd legendre(n_ring_);
  legendre_polynomials(std::cos(t), n_ring_ - 1, legendre.data());
  Eigen::Map<Eigen::VectorXd>(even, n_ring_) = nodes_to_legendre_.transpose() * legendre;
  for (int j = 0; j < n_ring_; ++j) odd[j] = even[j] * std::sin(t) / sin_t_[j];
}

// Mode 0 holds the constant e_1 as (1, 0, 0), mode 1 the constants normal to it as (0, 1, 1). What their rows miss of
// the exact answer multiplies the density at the closest point in every mode.
void ModalRows::remove_constant_defect(Singularity const& near, ModalRowSet& rows) const {
  int const n = n_ring_;
  Eigen::Matrix3d defect = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 2; ++i) {
    defect(i, 0) = (i == 0 ? near.jump : 0.0) - rows[0].row(i).head(n).sum();
    defect(i, 1) = (i == 1 ? near.jump : 0.0) - rows[1].row(i).tail(2 * n).sum();
  }
  defect(2, 2) = near.jump - rows[1].row(2).tail(2 * n).sum();
  std::vector<double> even(n), odd(n);
  interpolation_values(near.t, even.data(), odd.data());
  for (int m = 0; m < n_mode_; ++m)
    for (int c = 0; c < 3; ++c) {
      auto const& cardinal = is_odd_in_t(c, m) ? odd : even;
      for (int j = 0; j < n; ++j) rows[m].col(c * n + j) += defect.col(c) * cardinal[j];
    }
}

}  // namespace asterflow

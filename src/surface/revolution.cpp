#include "surface/revolution.hpp"

#include "base/error.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace asterflow {
namespace {

constexpr double pi = std::numbers::pi;

struct PolarProfile {
  double centre;
  std::vector<double> theta, radius;
};

PolarProfile polar_profile(std::vector<std::array<double, 2>> const& profile) {
  if (profile.size() < 3) throw SceneError("shape: profile must have at least 3 points (x, r), um");
  PolarProfile polar{0.5 * (profile.front()[0] + profile.back()[0]), {}, {}};
  for (auto const& [x, r] : profile) {
    double const theta = std::atan2(r, x - polar.centre), radius = std::hypot(r, x - polar.centre);
    if (!(radius > 0.0) || !std::isfinite(radius) || r < 0.0)
      throw SceneError(fmt::format("shape: profile point ({}, {}) um is not a point around the centre x = {} um", x, r, polar.centre));
    if (!polar.theta.empty() && theta >= polar.theta.back())
      throw SceneError(fmt::format("shape: profile is not star-shaped about x = {} um at the point ({}, {}) um: every ray from "
                                   "there must meet it once",
                                   polar.centre, x, r));
    polar.theta.push_back(theta);
    polar.radius.push_back(radius);
  }
  return polar;
}

std::vector<double> fit_cosines(PolarProfile const& profile) {
  auto const n_point = static_cast<int>(profile.theta.size());
  Eigen::Map<Eigen::VectorXd const> const radius(profile.radius.data(), n_point);
  int const highest = std::min(64, n_point <= 8 ? n_point - 1 : std::max(7, 2 * (n_point - 1) / 3));
  Eigen::MatrixXd basis(n_point, highest + 1);
  for (int i = 0; i < n_point; ++i)
    for (int k = 0; k <= highest; ++k) basis(i, k) = std::cos(k * profile.theta[i]);
  Eigen::VectorXd c;
  for (int degree = 1; degree <= highest; ++degree) {
    c = basis.leftCols(degree + 1).colPivHouseholderQr().solve(radius);
    double const residual = (basis.leftCols(degree + 1) * c - radius).lpNorm<Eigen::Infinity>();
    if (residual <= 1e-9 * radius.maxCoeff()) break;
    if (degree == highest && residual > 1e-2 * radius.maxCoeff())
      throw SceneError(fmt::format("shape: profile is not smooth enough for its {} points: the fit misses one by {} um", n_point, residual));
  }
  return {c.data(), c.data() + c.size()};
}

}  // namespace

Revolution::Revolution(std::vector<std::array<double, 2>> const& profile) : Shape(0) {
  PolarProfile const polar = polar_profile(profile);
  centre_ = polar.centre;
  coefficients_ = fit_cosines(polar);
  largest_ = 0.0;
  smallest_ = std::numeric_limits<double>::max();
  int const n_sample = 8 * static_cast<int>(coefficients_.size()) + 32;
  for (int i = 0; i <= n_sample; ++i) {
    double const theta = pi * i / n_sample, r = radius(theta)[0];
    largest_ = std::max(largest_, r);
    smallest_ = std::min(smallest_, r);
    samples_.push_back({r * std::cos(theta), r * std::sin(theta)});
  }
  if (smallest_ < 0.02 * largest_) throw SceneError("shape: profile comes too close to the midpoint of its poles");
}

std::array<double, 3> Revolution::radius(double theta) const {
  double const c1 = std::cos(theta), s1 = std::sin(theta);
  double c = 1.0, s = 0.0, value = 0.0, slope = 0.0, curvature = 0.0;
  for (std::size_t k = 0; k < coefficients_.size(); ++k) {
    auto const wavenumber = static_cast<double>(k);
    value += coefficients_[k] * c;
    slope -= coefficients_[k] * wavenumber * s;
    curvature -= coefficients_[k] * wavenumber * wavenumber * c;
    double const next = c * c1 - s * s1;
    s = s * c1 + c * s1;
    c = next;
  }
  return {value, slope, curvature};
}

Revolution::MeridianPoint Revolution::meridian(double theta) const {
  auto const [R, dR, ddR] = radius(theta);
  double const c = std::cos(theta), s = std::sin(theta);
  return {R * c, R * s, dR * c - R * s, dR * s + R * c, (ddR - R) * c - 2.0 * dR * s, (ddR - R) * s + 2.0 * dR * c};
}

SphereImage Revolution::image(Vec3d d) const {
  double const sine = std::hypot(d.y, d.z);
  auto const [R, dR, ddR] = radius(std::atan2(sine, d.x));
  double const slope = sine > 1e-8 ? dR / sine : (d.x > 0.0 ? ddR : -ddR);  // - dR / d(d_x)
  Eigen::Matrix3d jacobian = R * Eigen::Matrix3d::Identity();
  jacobian.col(0) -= slope * Eigen::Vector3d(d.x, d.y, d.z);
  return {{centre_ + R * d.x, R * d.y, R * d.z}, jacobian};
}

// With u = d_x, R = sum_k c_k T_k(u) by Clenshaw's recurrence; the area vector is R (R d - dR/du (e_x - u d)).
void Revolution::sample(Columns const& d, Columns& positions, Columns& areas) const {
  Eigen::ArrayXd const u = d.col(0), zero = Eigen::ArrayXd::Zero(u.size());
  Eigen::ArrayXd b1 = zero, b2 = zero, slope1 = zero, slope2 = zero, next;
  for (auto k = coefficients_.size() - 1; k > 0; --k) {
    next = 2.0 * (b1 + u * slope1) - slope2;
    slope2.swap(slope1);
    slope1.swap(next);
    next = coefficients_[k] + 2.0 * u * b1 - b2;
    b2.swap(b1);
    b1.swap(next);
  }
  Eigen::ArrayXd const R = coefficients_[0] + u * b1 - b2, slope = b1 + u * slope1 - slope2;
  positions.resize(d.rows(), 3);
  areas.resize(d.rows(), 3);
  for (int i = 0; i < 3; ++i) {
    positions.col(i) = R * d.col(i);
    areas.col(i) = R * (R + slope * u) * d.col(i);
  }
  positions.col(0) += centre_;
  areas.col(0) -= R * slope;
}

// Zero of (X - x) . X' next to the nearest sample: Newton, kept inside the bracket by bisection.
double Revolution::closest_angle(double z, double r) const {
  auto const n = static_cast<int>(samples_.size()) - 1;
  int best = 0;
  double least = std::numeric_limits<double>::max();
  for (int i = 0; i <= n; ++i) {
    double const square = std::pow(z - samples_[i][0], 2) + std::pow(r - samples_[i][1], 2);
    if (square < least) least = square, best = i;
  }
  double low = pi * std::max(best - 1, 0) / n, high = pi * std::min(best + 1, n) / n, theta = pi * best / n;
  for (int iteration = 0; iteration < 60; ++iteration) {
    MeridianPoint const p = meridian(theta);
    double const slope = (p.z - z) * p.dz + (p.r - r) * p.dr;
    double const curvature = p.dz * p.dz + p.dr * p.dr + (p.z - z) * p.ddz + (p.r - r) * p.ddr;
    (slope > 0.0 ? high : low) = theta;
    double next = theta - slope / curvature;
    if (!(curvature > 0.0) || next < low || next > high) next = 0.5 * (low + high);
    if (std::abs(next - theta) < 1e-15) return next;
    theta = next;
  }
  return theta;
}

ClosestPoint Revolution::closest_point(Vec3d x) const {
  double const z = x.x - centre_, r = std::hypot(x.y, x.z);
  double const theta = closest_angle(z, r), c = r > 0.0 ? x.y / r : 1.0, s = r > 0.0 ? x.z / r : 0.0;
  MeridianPoint const p = meridian(theta);
  double const stretch = std::hypot(p.dz, p.dr), n_z = p.dr / stretch, n_r = -p.dz / stretch;
  return {{centre_ + p.z, p.r * c, p.r * s},
          {n_z, n_r * c, n_r * s},
          n_z * (z - p.z) + n_r * (r - p.r),
          {std::cos(theta), std::sin(theta) * c, std::sin(theta) * s}};
}

ShellPoint Revolution::shell_point(Vec3d x) const {
  Vec3d const arm = x - centre();
  return {norm(arm) / radius(std::atan2(std::hypot(arm.y, arm.z), arm.x))[0], arm};
}

}  // namespace asterflow

#include "surface/grading.hpp"

#include "base/error.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace asterflow {
namespace {

constexpr double pi = std::numbers::pi;

// Jacobi amplitude am(u, k) by descending Landen transformations [Abramowitz & Stegun 16.4].
double jacobi_amplitude(double u, double k) {
  constexpr int n_max = 12;
  double a[n_max + 1], c[n_max + 1];
  double b = std::sqrt((1.0 - k) * (1.0 + k));
  a[0] = 1.0;
  c[0] = k;
  int n = 0;
  while (n < n_max && std::abs(c[n]) > 1e-17) {
    a[n + 1] = 0.5 * (a[n] + b);
    c[n + 1] = 0.5 * (a[n] - b);
    b = std::sqrt(a[n] * b);
    ++n;
  }
  double phi = std::ldexp(a[n] * u, n);
  for (; n > 0; --n) phi = 0.5 * (phi + std::asin(c[n] / a[n] * std::sin(phi)));
  return phi;
}

}  // namespace

Grading::Grading(Eigen::Matrix3d const& frame) : frame_(frame) {}

Grading::Grading(Eigen::Matrix3d const& frame, double width)
    : frame_(frame), modulus_(1.0 / std::sqrt(1.0 + 0.25 * width * width)), quarter_period_(std::comp_ellint_1(modulus_)) {
  ASTERFLOW_REQUIRE(width > 0.0);
}

Grading::PolarAngle Grading::polar_angle(double t) const {
  if (uniform()) return {t, 1.0};
  double const complement = jacobi_amplitude(quarter_period_ * (1.0 - t / pi), modulus_), sine = modulus_ * std::sin(complement);
  return {pi - 2.0 * complement, 2.0 * quarter_period_ / pi * std::sqrt((1.0 - sine) * (1.0 + sine))};
}

double Grading::grid_angle(double theta) const {
  if (uniform()) return theta;
  return pi * (1.0 - std::ellint_1(modulus_, 0.5 * (pi - theta)) / quarter_period_);
}

Eigen::Matrix3d axis_frame(int axis) {
  Eigen::Matrix3d frame = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) frame((axis + i) % 3, i) = 1.0;
  return frame;
}

Eigen::Matrix3d pole_frame(Vec3d pole) {
  return Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), Eigen::Vector3d(pole.x, pole.y, pole.z)).toRotationMatrix();
}

}  // namespace asterflow

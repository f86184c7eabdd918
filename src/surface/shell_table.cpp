#include "surface/shell_table.hpp"

#include "base/error.hpp"
#include "base/parallel.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace asterflow {
namespace {

using Eigen::MatrixXd;
constexpr double pi = std::numbers::pi;
constexpr int max_lanes = 48;  // numbers that interpolation reads from the place of the first node of a circle

// Values at `nodes` of functions cos(k x), k = first ... (even), or sin(k x) -> values divided by the window's transform
// at x_i = pi (i - margin) / n, ghosts included.
MatrixXd upsampling(std::vector<double> const& nodes, bool odd, int n, int margin, InterpolationWindow const& window) {
  auto const size = static_cast<Eigen::Index>(nodes.size());
  MatrixXd at_nodes(size, size), at_table(n + 1 + 2 * margin, size);
  for (Eigen::Index k = 0; k < size; ++k) {
    double const wavenumber = static_cast<double>(odd ? k + 1 : k);
    double const correction = 1.0 / window.transform(wavenumber / (2.0 * n));
    auto const basis = [&](double x) { return odd ? std::sin(wavenumber * x) : std::cos(wavenumber * x); };
    for (Eigen::Index i = 0; i < size; ++i) at_nodes(i, k) = basis(nodes[i]);
    for (Eigen::Index i = 0; i < at_table.rows(); ++i) at_table(i, k) = correction * basis(pi * (i - margin) / n);
  }
  return at_nodes.transpose().partialPivLu().solve(at_table.transpose()).transpose();
}

int cells(double oversampling, int n) { return static_cast<int>(std::ceil(oversampling * n)); }

int even_fft_size(int least) {  // smallest even 2^a 3^b 5^c
  for (int n = least + least % 2;; n += 2) {
    int rest = n;
    for (int const factor : {2, 3, 5})
      while (rest % factor == 0) rest /= factor;
    if (rest == 1) return n;
  }
}

}  // namespace

double shell_scale(int k, int n_shell) {
  double const c = k == n_shell - 1 ? 0.0 : std::cos(0.5 * pi * k / (n_shell - 1));
  return c * c;
}

ShellTable::ShellTable(SphereGrid const& grid, int n_shell, int window_width, double oversampling)
    : n_ring_(grid.n_ring()), n_mode_(grid.n_mode()), n_shell_(n_shell), window_(window_width, oversampling),
      n_psi_(cells(oversampling, n_shell)), n_theta_(cells(oversampling, n_ring_ + 1)),
      n_phi_(even_fft_size(2 * cells(oversampling, n_mode_))), margin_(window_width / 2), row_(n_phi_ + 2 * margin_ + 1),
      transform_(n_phi_) {
  ASTERFLOW_REQUIRE(n_shell >= 2);
  std::vector<double> psi;
  for (int k = 0; k < n_shell; ++k) psi.push_back(pi * k / (n_shell - 1));
  up_.psi = upsampling(psi, false, n_psi_, margin_, window_);
  for (bool const odd : {false, true}) up_.theta[odd] = upsampling(grid.polar_angles(), odd, n_theta_, margin_, window_);
  rough_up_ = {up_.psi.cast<float>(), {up_.theta[0].cast<float>(), up_.theta[1].cast<float>()}};
  for (int m = 0; m < n_mode_; ++m) phi_correction_.push_back(1.0 / window_.transform(static_cast<double>(m) / n_phi_));
}

template <>
ShellTable::Upsampling<double> const& ShellTable::up() const { return up_; }
template <>
ShellTable::Upsampling<float> const& ShellTable::up() const { return rough_up_; }

TablePoint ShellTable::locate(double psi, Vec3d d) {
  double const sine = std::hypot(d.y, d.z), theta = std::atan2(sine, d.x);
  double const turns = sine > 0.0 ? std::atan2(d.z, d.y) / (2.0 * pi) : 0.0;
  return {psi, theta / pi, turns - std::floor(turns), sine > 0.0 ? d.y / sine : 1.0, sine > 0.0 ? d.z / sine : 0.0};
}

std::size_t ShellTable::memory() const {
  auto const cells = static_cast<std::size_t>(up_.psi.rows() * up_.theta[0].rows());
  return sizeof(double) * cells * (3 * row_ + 6 * n_mode_);
}

ShellTable::Rows ShellTable::rows_of(PsiRange range) const {
  if (range.first > range.last) return {0, 0};
  long const first = window_.first_node(range.first * n_psi_) + margin_;
  long const end = window_.first_node(range.last * n_psi_) + margin_ + window_.width() + 1;  // whole vectors reach into the next row
  return {first, std::min(end, static_cast<long>(up_.psi.rows())) - first};
}

// Upsampling is a tensor product: theta and psi by small matrices mode by mode, phi by a Fourier transform.
template <class Real>
void ShellTable::fill(std::vector<ShellMode<Real>> const& modes, PsiRange range, Values<Real>& values) const {
  ASTERFLOW_REQUIRE(static_cast<int>(modes.size()) == n_mode_);
  values.velocity.resize(static_cast<std::size_t>(up_.psi.rows() * up_.theta[0].rows()) * 3 * row_ + max_lanes);
  values.meridian.resize(modes.size());
  Rows const rows = rows_of(range);
  parallel_for("ShellTable::fill_meridian", n_mode_,
               [&](long m) { fill_meridian(static_cast<int>(m), modes[m], rows, values.meridian[m]); });
  parallel_for("ShellTable::fill_azimuth", rows.count, [&](long i) { fill_azimuth(rows.first + i, values); });
}

template <class Real>
void ShellTable::fill_meridian(int m, ShellMode<Real> const& mode, Rows wanted, Eigen::MatrixX<Real>& fine) const {
  using Matrix = Eigen::MatrixX<Real>;
  auto const n_psi = up_.psi.rows(), n_theta = up_.theta[0].rows(), n_kept = mode.rows() / (3 * n_ring_);
  fine.resize(n_theta, 6 * n_psi);
  Matrix rings(n_theta, n_kept);
  for (int part = 0; part < 2; ++part)
    for (int c = 0; c < 3; ++c) {
      Eigen::Map<Matrix const, 0, Eigen::OuterStride<>> const coarse(mode.col(part).data() + c * n_ring_, n_ring_, n_kept,
                                                                     Eigen::OuterStride<>(3 * n_ring_));
      bool const odd = ((c > 0) + m) % 2 != 0;
      rings.noalias() = up<Real>().theta[odd] * coarse;
      rings *= static_cast<Real>(phi_correction_[m]);
      fine.middleCols((part * 3 + c) * n_psi + wanted.first, wanted.count).noalias() =
          rings * up<Real>().psi.block(wanted.first, 0, wanted.count, n_kept).transpose();
    }
}

template <class Real>
void ShellTable::fill_azimuth(long i_psi, Values<Real>& values) const {
  auto const n_psi = up_.psi.rows(), n_theta = up_.theta[0].rows();
  long const n_coefficient = n_phi_ / 2 + 1;
  std::vector<std::complex<double>> spectra(n_theta * n_coefficient);  // the modes that are not set stay zero
  std::vector<std::complex<double>> spectrum(n_coefficient);           // overwritten by the transform
  std::vector<double> circle(n_phi_);
  for (int c = 0; c < 3; ++c) {
    for (int m = 0; m < n_mode_; ++m) {
      Real const* const re = values.meridian[m].col(c * n_psi + i_psi).data();
      Real const* const im = values.meridian[m].col((3 + c) * n_psi + i_psi).data();
      for (Eigen::Index j = 0; j < n_theta; ++j)
        spectra[j * n_coefficient + m] = c < 2 ? std::complex<double>(re[j], im[j]) : std::complex<double>(-im[j], re[j]);
    }
    for (Eigen::Index j = 0; j < n_theta; ++j) {
      std::copy_n(&spectra[j * n_coefficient], n_coefficient, spectrum.data());
      transform_.synthesise(spectrum.data(), circle.data());
      Real* const row = values.velocity.data() + (i_psi * n_theta + j) * 3 * row_ + c;
      for (int k = 0; k < n_phi_; ++k) row[3 * (margin_ + k)] = static_cast<Real>(circle[k]);
      for (int g = 0; g < margin_; ++g) row[3 * g] = row[3 * (g + n_phi_)];
      for (int g = margin_ + n_phi_; g < row_; ++g) row[3 * g] = row[3 * (g - n_phi_)];
    }
  }
}

template <int width, class Real>
void ShellTable::interpolate_with(Values<Real> const& values, TablePoint const& point, double velocity[3]) const {
  double weights[3][width];
  long first[3];
  double const position[3] = {point.psi * n_psi_, point.theta * n_theta_, point.phi * n_phi_};
  for (int d = 0; d < 3; ++d) first[d] = window_.weigh(width, position[d], weights[d]) + margin_;
  constexpr int lanes = (3 * width + 7) / 8 * 8;  // whole vectors of (node, component); the rest weighs nothing
  Real sums[lanes] = {};
  auto const n_theta = up_.theta[0].rows();
  for (int a = 0; a < width; ++a)
    for (int b = 0; b < width; ++b) {
      Real const w = static_cast<Real>(weights[0][a] * weights[1][b]);
      Real const* const row = values.velocity.data() + (((first[0] + a) * n_theta + first[1] + b) * row_ + first[2]) * 3;
      for (int i = 0; i < lanes; ++i) sums[i] += w * row[i];
    }
  double u[3] = {};
  for (int i = 0; i < width; ++i)
    for (int c = 0; c < 3; ++c) u[c] += weights[2][i] * sums[3 * i + c];
  velocity[0] = u[0];
  velocity[1] = u[1] * point.cos_phi - u[2] * point.sin_phi;
  velocity[2] = u[1] * point.sin_phi + u[2] * point.cos_phi;
}

template <class Real>
void ShellTable::interpolate(Values<Real> const& values, TablePoint const& point, double velocity[3]) const {
  switch (window_.width()) {
    case 6: return interpolate_with<6>(values, point, velocity);
    case 8: return interpolate_with<8>(values, point, velocity);
    case 10: return interpolate_with<10>(values, point, velocity);
    case 12: return interpolate_with<12>(values, point, velocity);
    case 14: return interpolate_with<14>(values, point, velocity);
    default: return interpolate_with<16>(values, point, velocity);
  }
}

template void ShellTable::fill(std::vector<ShellMode<double>> const&, PsiRange, Values<double>&) const;
template void ShellTable::fill(std::vector<ShellMode<float>> const&, PsiRange, Values<float>&) const;
template void ShellTable::interpolate(Values<double> const&, TablePoint const&, double[3]) const;
template void ShellTable::interpolate(Values<float> const&, TablePoint const&, double[3]) const;

}  // namespace asterflow

#include "surface/shell_table.hpp"

#include "base/error.hpp"
#include "base/parallel.hpp"

#include <algorithm>

namespace asterflow {

using Eigen::MatrixXd;

void ShellTable::collect(std::vector<TablePoint> const& points, ConstPoints forces, std::vector<ShellMode<double>>& modes,
                         Collection& work) const {
  ASTERFLOW_REQUIRE(points.size() == forces.size() && static_cast<int>(modes.size()) == n_mode_);
  weigh_forces(points, forces, work);
  work.meridian.resize(modes.size());
  for (auto& fine : work.meridian) fine.resize(up_.theta[0].rows(), 6 * up_.psi.rows());
  parallel_for("ShellTable::collect_azimuth", up_.psi.rows(), [&](long i) { collect_azimuth(i, work); });
  parallel_for("ShellTable::collect_meridian", n_mode_,
               [&](long m) { collect_meridian(static_cast<int>(m), work.meridian[m], modes[m]); });
}

void ShellTable::weigh_forces(std::vector<TablePoint> const& points, ConstPoints forces, Collection& work) const {
  int const width = window_.width();
  work.forces.resize(points.size());
  parallel_for("ShellTable::weigh_forces", static_cast<long>(points.size()), [&](long j) {
    TablePoint const& point = points[j];
    Collection::Force& force = work.forces[j];
    double phi[16];
    force.first[0] = window_.weigh(width, point.psi * n_psi_, force.psi) + margin_;
    force.first[1] = window_.weigh(width, point.theta * n_theta_, force.theta) + margin_;
    force.first[2] = window_.weigh(width, point.phi * n_phi_, phi) + margin_;
    Vec3d const f = forces[j];
    double const f_r = f.y * point.cos_phi + f.z * point.sin_phi, f_phi = f.z * point.cos_phi - f.y * point.sin_phi;
    for (int i = 0; i < width; ++i) {
      force.phi[3 * i] = phi[i] * f.x;
      force.phi[3 * i + 1] = phi[i] * f_r;
      force.phi[3 * i + 2] = phi[i] * f_phi;
    }
  });
  work.starting.resize(up_.psi.rows());
  for (auto& row : work.starting) row.clear();
  for (std::size_t j = 0; j < points.size(); ++j) work.starting[work.forces[j].first[0]].push_back(j);
}

// Forces on the nodes of one psi, and their Fourier coefficients.
void ShellTable::collect_azimuth(long i_psi, Collection& work) const {
  auto const n_psi = up_.psi.rows(), n_theta = up_.theta[0].rows();
  long const width = window_.width(), lanes = 3 * width;
  std::vector<double> grid(static_cast<std::size_t>(n_theta) * 3 * row_);
  for (long start = std::max(0L, i_psi - width + 1); start <= i_psi; ++start)
    for (std::size_t const j : work.starting[start]) {
      Collection::Force const& force = work.forces[j];
      for (long b = 0; b < width; ++b) {
        double const w = force.psi[i_psi - start] * force.theta[b];
        double* const row = grid.data() + 3 * ((force.first[1] + b) * row_ + force.first[2]);
        for (long i = 0; i < lanes; ++i) row[i] += w * force.phi[i];
      }
    }
  std::vector<double> circle(n_phi_);
  std::vector<std::complex<double>> spectrum(n_phi_ / 2 + 1);
  for (Eigen::Index j = 0; j < n_theta; ++j)
    for (int c = 0; c < 3; ++c) {
      double const* const row = grid.data() + 3 * j * row_ + c;
      for (int k = 0; k < n_phi_; ++k) circle[k] = row[3 * (margin_ + k)];
      for (int g = 0; g < margin_; ++g) circle[n_phi_ - margin_ + g] += row[3 * g];
      for (int g = margin_ + n_phi_; g < row_; ++g) circle[g - margin_ - n_phi_] += row[3 * g];
      transform_.analyse(circle.data(), spectrum.data());
      for (int m = 0; m < n_mode_; ++m) {
        auto const f = c < 2 ? spectrum[m] : spectrum[m] * std::complex(0.0, -1.0);
        work.meridian[m](j, c * n_psi + i_psi) = f.real();
        work.meridian[m](j, (3 + c) * n_psi + i_psi) = f.imag();
      }
    }
}

void ShellTable::collect_meridian(int m, MatrixXd const& fine, ShellMode<double>& mode) const {
  auto const n_psi = up_.psi.rows(), n_kept = mode.rows() / (3 * n_ring_);
  for (int part = 0; part < 2; ++part)
    for (int c = 0; c < 3; ++c) {
      bool const odd = ((c > 0) + m) % 2 != 0;
      MatrixXd rings = fine.middleCols((part * 3 + c) * n_psi, n_psi) * up_.psi.leftCols(n_kept);
      rings *= phi_correction_[m] * n_phi_;
      Eigen::Map<MatrixXd, 0, Eigen::OuterStride<>> coarse(mode.col(part).data() + c * n_ring_, n_ring_, n_kept,
                                                           Eigen::OuterStride<>(3 * n_ring_));
      coarse.noalias() = up_.theta[odd].transpose() * rings;
    }
}

}  // namespace asterflow

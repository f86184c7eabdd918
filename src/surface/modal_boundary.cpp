#include "surface/modal_boundary.hpp"

#include "base/error.hpp"
#include "base/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace asterflow {
namespace {

using Eigen::MatrixXd;
using LoadVelocity = Eigen::Matrix<double, 3, 2>;
constexpr double pi = std::numbers::pi;

}  // namespace

Eigen::Matrix<double, 3, 2> modal_velocity_of_load(int m, CylindricalPoint x) {
  double const inverse = 1.0 / std::hypot(x.z, x.r), cube = inverse * inverse * inverse;
  LoadVelocity u;
  if (m == 0)
    u << inverse + x.z * x.z * cube, 0.0, x.z * x.r * cube, 0.0, 0.0, x.r * cube;
  else
    u << x.z * x.r * cube, -x.r * cube, inverse + x.r * x.r * cube, x.z * cube, inverse, x.z * cube;
  return u / (8.0 * pi);
}

ModalBoundary::ModalBoundary(Surface const& surface, Side side, double digits)
    : surface_(surface), side_(side), rows_(surface, digits), transform_(surface.grid().n_azimuth()) {
  ASTERFLOW_REQUIRE(surface.axisymmetric());
  std::vector<ModalRowSet> rings(n_ring());
  parallel_for("ModalBoundary::rings", n_ring(),
               [&](long j) { rings[j] = rows_.on_surface(surface_.grid().polar_angles()[j]); });
  for (int m = 0; m < n_mode(); ++m) equations_.push_back(assemble(m, rings));
}

CylindricalPoint ModalBoundary::ring(int j) const {
  Vec3d const point = surface_.patch(surface_.grid().polar_angles()[j], 0.0).position;
  Vec3d const arm = surface_.to_polar(point - surface_.shape().centre());
  return {arm.x, arm.y};
}

// Rows of force and torque in the density of mode m, see the header.
ModalBoundary::LoadRows ModalBoundary::load_of_density(int m) const {
  int const n = n_ring();
  LoadRows rows = LoadRows::Zero(2, 3 * n);
  double const factor = -2.0 / std::sqrt(surface_.area() / (4.0 * pi));
  for (int j = 0; j < n; ++j) {
    auto const node = static_cast<std::size_t>(j) * surface_.grid().n_azimuth();
    double const weight = factor * surface_.weights()[node] * surface_.grid().n_azimuth();  // the whole ring
    CylindricalPoint const y = ring(j);
    if (m == 0) {
      rows(0, j) = weight;
      rows(1, 2 * n + j) = weight * y.r;
    } else {
      for (int c : {1, 2}) rows(0, c * n + j) = 0.5 * weight;
      for (int c : {1, 2}) rows(1, c * n + j) = 0.5 * weight * y.z;
      rows(1, j) = -0.5 * weight * y.r;
    }
  }
  return rows;
}

MatrixXd ModalBoundary::assemble(int m, std::vector<ModalRowSet> const& rings) const {
  int const n_ring = this->n_ring();
  MatrixXd a(3 * n_ring, 3 * n_ring);
  for (int c = 0; c < 3; ++c)
    for (int j = 0; j < n_ring; ++j) a.row(c * n_ring + j) = rings[j][m].row(c);
  a.diagonal().array() += side_ == Side::interior ? 0.5 : -0.5;
  if (side_ == Side::interior && m == 0) {
    Eigen::VectorXd normal = Eigen::VectorXd::Zero(3 * n_ring), flux = normal;
    for (int j = 0; j < n_ring; ++j) {
      auto const node = static_cast<std::size_t>(j) * surface_.grid().n_azimuth();
      Vec3d const n = surface_.to_polar(surface_.normals()[node]);
      for (int c = 0; c < 2; ++c) {
        normal[c * n_ring + j] = n[c];
        flux[c * n_ring + j] = n[c] * surface_.weights()[node] * surface_.grid().n_azimuth() / surface_.area();
      }
    }
    a += normal * flux.transpose();
  }
  if (side_ == Side::exterior && m < 2) {
    LoadRows const loads = load_of_density(m);
    for (int j = 0; j < n_ring; ++j) {
      LoadVelocity const u = modal_velocity_of_load(m, ring(j));
      for (int c = 0; c < 3; ++c) a.row(c * n_ring + j) += u.row(c) * loads;
    }
  }
  return a;
}

namespace {

struct AzimuthFrames {
  explicit AzimuthFrames(SphereGrid const& grid) {
    for (int k = 0; k < grid.n_azimuth(); ++k) {
      cosines.push_back(std::cos(grid.azimuth(k)));
      sines.push_back(std::sin(grid.azimuth(k)));
    }
  }
  std::vector<double> cosines, sines;
};

}  // namespace

std::vector<RingMode> analyse_modes(Surface const& surface, AzimuthTransform const& transform, ConstPoints field) {
  ASTERFLOW_REQUIRE(field.size() == surface.size());
  auto const& grid = surface.grid();
  int const n = grid.n_azimuth();
  std::vector<RingMode> modes(grid.n_mode(), RingMode(3 * grid.n_ring(), 2));
  std::vector<double> values(3 * n);
  std::vector<std::complex<double>> coefficients(n / 2 + 1);
  AzimuthFrames const frames(grid);
  for (int j = 0; j < grid.n_ring(); ++j) {
    for (int k = 0; k < n; ++k) {
      Vec3d const w = surface.to_polar(field[static_cast<std::size_t>(j) * n + k]);
      double const c = frames.cosines[k], s = frames.sines[k];
      values[k] = w.x;
      values[n + k] = c * w.y + s * w.z;
      values[2 * n + k] = c * w.z - s * w.y;
    }
    for (int c = 0; c < 3; ++c) {
      transform.analyse(values.data() + c * n, coefficients.data());
      for (int m = 0; m < grid.n_mode(); ++m) {
        auto const f = c < 2 ? coefficients[m] : coefficients[m] * std::complex(0.0, -1.0);
        modes[m].row(c * grid.n_ring() + j) << f.real(), f.imag();
      }
    }
  }
  return modes;
}

void add_synthesis(Surface const& surface, AzimuthTransform const& transform, std::vector<RingMode> const& modes,
                   Points field) {
  ASTERFLOW_REQUIRE(field.size() == surface.size());
  auto const& grid = surface.grid();
  int const n = grid.n_azimuth(), n_ring = grid.n_ring();
  std::vector<double> values(3 * n);
  std::vector<std::complex<double>> coefficients(n / 2 + 1);
  AzimuthFrames const frames(grid);
  for (int j = 0; j < n_ring; ++j) {
    for (int c = 0; c < 3; ++c) {
      coefficients.back() = 0.0;
      for (int m = 0; m < grid.n_mode(); ++m) {
        std::complex<double> const f(modes[m](c * n_ring + j, 0), modes[m](c * n_ring + j, 1));
        coefficients[m] = c < 2 ? f : f * std::complex(0.0, 1.0);
      }
      transform.synthesise(coefficients.data(), values.data() + c * n);
    }
    for (int k = 0; k < n; ++k) {
      double const c = frames.cosines[k], s = frames.sines[k];
      field[static_cast<std::size_t>(j) * n + k] += surface.from_polar(
          {values[k], c * values[n + k] - s * values[2 * n + k], s * values[n + k] + c * values[2 * n + k]});
    }
  }
}

void ModalBoundary::synthesise(std::vector<Mode> const& modes, Points field) const {
  std::ranges::fill(field, Vec3d{});
  add_synthesis(surface_, transform_, modes, field);
}

Eigen::Matrix<double, 6, 1> ModalBoundary::load(Eigen::Matrix2d const& axial, Eigen::Matrix2d const& transverse) {
  Eigen::Matrix<double, 6, 1> load;  // rows of the arguments: force, torque; columns: real, imaginary
  load << axial(0, 0), 2.0 * transverse(0, 0), -2.0 * transverse(0, 1),  //
      -axial(1, 1), 2.0 * transverse(1, 1), 2.0 * transverse(1, 0);
  return load;
}

}  // namespace asterflow

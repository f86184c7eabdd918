#include "surface/screened_forces.hpp"

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "kernels/stokeslet.hpp"
#include "surface/curvature_image.hpp"
#include "surface/graded_rule.hpp"
#include "surface/modal_boundary.hpp"
#include "surface/plane_image.hpp"
#include "surface/two_columns.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace asterflow {
namespace {

using Eigen::MatrixXd;
constexpr double pi = std::numbers::pi;
constexpr int extra_order = 4;  // of the feet of forces: columns are less smooth in them than rows are
constexpr int n_shell = 14;      // over the depth

// Orthonormal associated Legendre functions, int_0^pi P_l^m P_k^m sin t dt = delta_lk: columns m, rows l from 0 to p, zero for l < m.
void fill_legendre(double t, Eigen::Ref<MatrixXd> p) {
  double const x = std::cos(t), y = std::sin(t);
  p.setZero();
  double diagonal = std::sqrt(0.5);
  for (Eigen::Index m = 0; m < std::min(p.rows(), p.cols()); ++m) {
    if (m > 0) diagonal *= -y * std::sqrt((2.0 * m + 1.0) / (2.0 * m));
    p(m, m) = diagonal;
    if (m + 1 < p.rows()) p(m + 1, m) = x * std::sqrt(2.0 * m + 3.0) * diagonal;
    for (Eigen::Index l = m + 2; l < p.rows(); ++l) {
      double const a = std::sqrt((4.0 * l * l - 1.0) / (1.0 * l * l - m * m)), k = l - 1.0;
      double const b = std::sqrt((k * k - m * m) / (4.0 * k * k - 1.0));
      p(l, m) = a * (x * p(l - 1, m) - b * p(l - 2, m));
    }
  }
}

}  // namespace

// Of a force in the table, in the half plane of azimuth 0: components (axial, radial, 0) from the origin of the shape's frame.
struct ScreenedForces::Place {
  Vec3d position, foot, normal;  // normal: into the fluid
  double t, distance;            // of the foot
  LocalGeometry shape;           // tangents as the rest
};

ScreenedForces::ScreenedForces(ImageWall const& wall, double accuracy)
    : wall_(wall), surface_(wall.surface()), n_ring_(surface_.grid().n_ring()), n_mode_(surface_.grid().n_mode()),
      places_(surface_.order() + extra_order, n_ring_ + extra_order),
      table_(places_, n_shell, InterpolationWindow::width_for(accuracy), 2.0), transform_(surface_.grid().n_azimuth()) {
  ASTERFLOW_REQUIRE(surface_.axisymmetric() && surface_.grading().uniform() && !wall.is_body());
  MatrixXd legendre(n_ring_, n_mode_ + 1);
  basis_at_rings_.assign(n_mode_ + 1, MatrixXd(n_ring_, n_ring_));
  for (int j = 0; j < n_ring_; ++j) {
    fill_legendre(surface_.grid().polar_angles()[j], legendre);
    for (int m = 0; m <= n_mode_; ++m) basis_at_rings_[m].row(j) = legendre.col(m).transpose();
  }
  assemble(accuracy);
}

TablePoint ScreenedForces::locate(Vec3d direction, double distance_over_reach) const {
  ASTERFLOW_REQUIRE(distance_over_reach >= 0.0 && distance_over_reach <= ImageWall::deepest);
  return ShellTable::locate(2.0 / pi * std::asin(std::sqrt(distance_over_reach / ImageWall::deepest)),
                            surface_.to_polar(direction));
}

ScreenedForces::Place ScreenedForces::place(int ring, int shell) const {
  double const t = places_.polar_angles()[ring];
  LocalGeometry shape = local_geometry(surface_.shape(), surface_.from_polar({std::cos(t), std::sin(t), 0.0}));
  double const distance = (1.0 - shell_scale(shell, n_shell)) * ImageWall::deepest * wall_.reach(shape);
  for (Vec3d& tangent : shape.tangent) tangent = surface_.to_polar(tangent);
  SurfacePatch const patch = surface_.patch(t, 0.0);
  Vec3d const foot = surface_.to_polar(patch.position), inwards = surface_.to_polar(-1.0 * normalized(patch.area_vector()));
  return {foot + distance * inwards, foot, inwards, t, distance, shape};
}

namespace {

// Fourier coefficients of the velocities along a ring, real as in modal_rows.hpp: [mode, 3 out + in].
using RingModes = Eigen::Matrix<double, Eigen::Dynamic, 9>;

void analyse_ring(std::vector<RulePoint> const& azimuth, RingModes const& u, RingModes& modes) {
  modes.setZero();
  for (std::size_t k = 0; k < azimuth.size(); ++k) {
    double const c = std::cos(azimuth[k].x), s = std::sin(azimuth[k].x), weight = azimuth[k].weight / (2.0 * pi);
    double even[9] = {}, odd[9] = {};  // in phi
    for (int in = 0; in < 3; ++in) {
      auto const v = u.row(static_cast<Eigen::Index>(k)).segment<3>(3 * in);
      bool const turns = in == 2;  // a force along the azimuth
      double* const straight = turns ? odd : even;
      double* const across = turns ? even : odd;
      straight[in] = weight * v[0];
      straight[3 + in] = weight * (c * v[1] + s * v[2]);
      across[6 + in] = (turns ? weight : -weight) * (c * v[2] - s * v[1]);
    }
    double cosine = 1.0, sine = 0.0;
    for (Eigen::Index m = 0; m < modes.rows(); ++m) {
      for (int e = 0; e < 9; ++e) modes(m, e) += cosine * even[e] + sine * odd[e];
      double const next = cosine * c - sine * s;
      sine = cosine * s + sine * c;
      cosine = next;
    }
  }
}

}  // namespace

// Of unit forces with their images at the points of a ring, (axial, radial, 0) at azimuth 0.
void ScreenedForces::ring_velocities(Place const& place, Vec3d ring, double digits, std::vector<RulePoint>& azimuth,
                                     RingVelocities& u) const {
  double const gap = std::hypot(ring.x - place.position.x, ring.y - place.position.y), product = ring.y * place.position.y;
  double const width = product > 0.0 ? 2.0 * std::asinh(0.5 * gap / std::sqrt(product)) : 10.0;
  half_period_rule(std::min(10.0, width), {digits, n_mode_ + 1.0}, azimuth);
  PointArray points;
  for (auto const& point : azimuth) points.push_back({ring.x, ring.y * std::cos(point.x), ring.y * std::sin(point.x)});
  auto const n = static_cast<long>(points.size());
  u.resize(n, 9);
  for (int c = 0; c < 3; ++c) {
    Vec3d force;
    force[c] = 1.0;
    PlaneImage<double> const plane(force, place.foot, place.normal, place.distance);
    CurvatureImage<double> const curvature(force, place.foot, place.normal, place.distance, place.shape);
    for (long first = 0; first < n; first += n_lane<double>) {
      LanesOfVectors<double> v;
      auto const x = gather<double>(points, first, n - first);
      plane.add(x, v);
      if (wall_.has_curvature()) curvature.add(x, v);
      for (long k = first; k < std::min(n, first + n_lane<double>); ++k) {
        Vec3d const direct = Stokeslet::velocity(points[k] - place.position, force);
        Lanes<double> const* const of_image[3] = {&v.x, &v.y, &v.z};
        for (int i = 0; i < 3; ++i) u(k, 3 * c + i) = direct[i] + Stokeslet::prefactor * (*of_image[i])[k - first];
      }
    }
  }
}

// Integrals over the wall of the kernel against all basis functions, and their values at the rings. The components
// u_r +- i u_phi of mode m are the Cartesian ones u_2 +- i u_3 of mode m +- 1.
ScreenedForces::ModalColumns ScreenedForces::project(Place const& place, double digits) const {
  std::vector<RulePoint> meridian, azimuth;
  double const speed = norm(surface_.patch(place.t, 0.0).tangent_t);
  append_graded_rule(0.0, place.t, pi, place.distance / speed, {digits, n_ring_ + 1.0}, meridian);
  auto const n_t = static_cast<Eigen::Index>(meridian.size());
  std::vector<MatrixXd> modes(n_mode_, MatrixXd(n_t, 9)), basis(n_mode_ + 1, MatrixXd(n_ring_, n_t));
  MatrixXd legendre(n_ring_, n_mode_ + 1);
  RingVelocities u;
  RingModes ring(n_mode_, 9);
  for (Eigen::Index s = 0; s < n_t; ++s) {
    double const t = meridian[s].x;
    ring_velocities(place, surface_.to_polar(surface_.patch(t, 0.0).position), digits, azimuth, u);
    analyse_ring(azimuth, u, ring);
    for (int m = 0; m < n_mode_; ++m) modes[m].row(s) = meridian[s].weight * std::sin(t) * ring.row(m);
    fill_legendre(t, legendre);
    for (int m = 0; m <= n_mode_; ++m) basis[m].col(s) = legendre.col(m);
  }
  ModalColumns columns(n_mode_, Eigen::Matrix<double, Eigen::Dynamic, 3>(3 * n_ring_, 3));
  for (int m = 0; m < n_mode_; ++m) {
    auto const at_rings = [&](int order, MatrixXd const& values) -> MatrixXd {
      return basis_at_rings_[order] * (basis[order] * values);
    };
    MatrixXd const radial = modes[m].middleCols<3>(3), azimuthal = modes[m].rightCols<3>();
    MatrixXd const plus = at_rings(m + 1, radial - azimuthal), minus = at_rings(std::abs(m - 1), radial + azimuthal);
    columns[m] << at_rings(m, modes[m].leftCols<3>()), 0.5 * (minus + plus), 0.5 * (minus - plus);
  }
  return columns;
}

void ScreenedForces::assemble(double accuracy) {
  double const digits = std::clamp(1.5 - std::log10(accuracy), 4.0, 13.0);
  int const n_place = places_.n_ring();
  matrices_.assign(n_mode_, MatrixXd(3 * n_ring_, 3 * n_place * n_shell));
  parallel_for("ScreenedForces::assemble", static_cast<long>(n_shell) * n_place, [&](long i) {
    int const shell = static_cast<int>(i / n_place), ring = static_cast<int>(i % n_place);
    ModalColumns const columns = project(place(ring, shell), digits);
    for (int m = 0; m < n_mode_; ++m)
      for (int c = 0; c < 3; ++c) matrices_[m].col((shell * 3 + c) * n_place + ring) = columns[m].col(c);
  });
  // Modes are left out on shells where they are below the accuracy of the flow at the size of the wall.
  double const negligible = 0.1 * accuracy * Stokeslet::prefactor / surface_.shape().size();
  for (auto& matrix : matrices_) {
    int kept = n_shell;
    while (kept > 1 && matrix.middleCols((kept - 1) * 3 * n_place, 3 * n_place).lpNorm<Eigen::Infinity>() < negligible) --kept;
    matrix = matrix.leftCols(kept * 3 * n_place).eval();
  }
}

void ScreenedForces::add_velocity(std::vector<TablePoint> const& points, ConstPoints forces, Points velocity) const {
  if (points.empty()) return;
  collected_.resize(places_.n_mode());
  modes_.resize(n_mode_);
  for (int m = 0; m < places_.n_mode(); ++m) collected_[m].resize(m < n_mode_ ? matrices_[m].cols() : 0, 2);
  PointArray in_polar(forces.size());
  std::ranges::transform(forces, in_polar.begin(), [&](Vec3d f) { return surface_.to_polar(f); });
  table_.collect(points, in_polar, collected_, work_);
  parallel_for("ScreenedForces::modes", n_mode_, [&](long m) { multiply<double>(matrices_[m], collected_[m], modes_[m]); });
  add_synthesis(surface_, transform_, modes_, velocity);
}

std::size_t ScreenedForces::memory() const {
  std::size_t bytes = work_.forces.capacity() * sizeof(ShellTable::Collection::Force);
  for (auto const& matrix : matrices_) bytes += sizeof(double) * static_cast<std::size_t>(matrix.size());
  for (auto const& fine : work_.meridian) bytes += sizeof(double) * static_cast<std::size_t>(fine.size());
  return bytes;
}

}  // namespace asterflow

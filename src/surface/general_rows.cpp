#include "surface/general_rows.hpp"

#include "linalg/quadrature.hpp"
#include "surface/graded_rule.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace asterflow {
namespace {

using Eigen::MatrixXd;
constexpr double pi = std::numbers::pi;
constexpr int n_entry = 6;  // xx, xy, xz, yy, yz, zz
constexpr int entry_of[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};

void write_entries(Vec3d r, double factor, Eigen::Ref<Eigen::Matrix<double, 1, n_entry>, 0, Eigen::InnerStride<>> row) {
  row << factor * r.x * r.x, factor * r.x * r.y, factor * r.x * r.z, factor * r.y * r.y, factor * r.y * r.z,
      factor * r.z * r.z;
}

// Columns 1, cos phi ... cos p phi, sin phi ... sin p phi.
void trigonometric_row(double phi, int order, MatrixXd& basis, Eigen::Index row) {
  double const c1 = std::cos(phi), s1 = std::sin(phi);
  double c = 1.0, s = 0.0;
  for (int m = 0; m <= order; ++m) {
    basis(row, m) = c;
    if (m > 0) basis(row, order + m) = s;
    double const next = c * c1 - s * s1;
    s = s * c1 + c * s1;
    c = next;
  }
}

int mode_of_column(int column, int order) { return column <= order ? column : column - order; }

}  // namespace

GeneralRows::GeneralRows(Surface const& surface, double digits)
    : surface_(surface), order_(surface.order()), digits_(digits) {
  auto const& grid = surface.grid();
  int const n = grid.n_ring(), n_azimuth = grid.n_azimuth();
  nodes_to_legendre_.resize(n, n);
  std::vector<double> values(n);
  for (int j = 0; j < n; ++j) {
    legendre_polynomials(std::cos(grid.polar_angles()[j]), order_, values.data());
    for (int l = 0; l < n; ++l) nodes_to_legendre_(l, j) = grid.ring_weights()[j] * (l + 0.5) * values[l];
  }
  MatrixXd basis(n_azimuth, 2 * order_ + 1);
  for (int k = 0; k < n_azimuth; ++k) trigonometric_row(grid.azimuth(k), order_, basis, k);
  modes_to_nodes_ = 2.0 / n_azimuth * basis.transpose();
  modes_to_nodes_.row(0) *= 0.5;
}

NodeRows GeneralRows::at(Vec3d target) const {
  ClosestAngles const closest = surface_.closest_angles(target);
  return integrate(target, {closest.t, closest.phi, std::abs(closest.distance), closest.distance < 0 ? 1.0 : 0.0});
}

NodeRows GeneralRows::on_surface(std::size_t node) const {
  auto const n = static_cast<std::size_t>(surface_.grid().n_azimuth());
  double const t = surface_.grid().polar_angles()[node / n], phi = surface_.grid().azimuth(static_cast<int>(node % n));
  return integrate(surface_.nodes()[node], {t, phi, 0.0, 0.5});
}

// Gauss-Newton for the minimum of |x - X(t, phi)| along a ring; it needs to be right only where the ring comes close.
double GeneralRows::closest_azimuth(Vec3d target, Grading::PolarAngle ring, double guess) const {
  double phi = guess;
  for (int iteration = 0; iteration < 6; ++iteration) {
    SurfacePatch const patch = surface_.patch(ring, phi);
    double const square = dot(patch.tangent_phi, patch.tangent_phi);
    if (square == 0.0) return guess;
    double const change = dot(target - patch.position, patch.tangent_phi) / square;
    phi += std::clamp(change, -0.5, 0.5);
    if (std::abs(change) < 1e-3 * norm(target - patch.position) / std::sqrt(square)) break;
  }
  return phi;
}

NodeRows GeneralRows::integrate(Vec3d target, Singularity const& near) const {
  int const n_column = 2 * order_ + 1;
  GradedRuleOptions const options{digits_, order_ + 2.0};
  double const stretch = norm(surface_.patch(near.t, near.phi).tangent_t);
  std::vector<RulePoint> meridian, azimuth;
  append_graded_rule(0.0, near.t, pi, near.distance / stretch, options, meridian);

  MatrixXd modal(meridian.size(), n_entry * n_column), kernel, basis;
  std::vector<double> t;
  for (std::size_t s = 0; s < meridian.size(); ++s) {
    t.push_back(meridian[s].x);
    Grading::PolarAngle const angle = surface_.grading().polar_angle(t.back());
    double const centre = closest_azimuth(target, angle, near.phi);
    SurfacePatch const closest = surface_.patch(angle, centre);
    double const speed = norm(closest.tangent_phi), gap = norm(target - closest.position);
    periodic_rule(centre, gap > 10.0 * speed ? 10.0 : gap / speed, options, azimuth);
    auto const n = static_cast<Eigen::Index>(azimuth.size());
    kernel.resize(n, n_entry);
    basis.resize(n, n_column);
    for (Eigen::Index k = 0; k < n; ++k) {
      SurfacePatch const y = surface_.patch(angle, azimuth[k].x);
      Vec3d const r = target - y.position;
      double const inverse = 1.0 / dot(r, r), cube = inverse * std::sqrt(inverse);
      double const weight = meridian[s].weight * azimuth[k].weight;
      write_entries(r, -3.0 / (4.0 * pi) * weight * dot(r, y.area_vector()) * inverse * cube, kernel.row(k));
      trigonometric_row(azimuth[k].x, order_, basis, k);
    }
    MatrixXd const ring = basis.transpose() * kernel;
    modal.row(s) = Eigen::Map<Eigen::RowVectorXd const>(ring.data(), ring.size());
  }
  NodeRows rows = to_nodes(t, modal);
  Eigen::Matrix3d defect = near.jump * Eigen::Matrix3d::Identity();
  for (Eigen::Index i = 0; i < rows.cols(); i += 3) defect -= rows.middleCols<3>(i);
  Eigen::VectorXd const cardinal = cardinal_functions(near.t, near.phi);
  for (Eigen::Index i = 0; i < cardinal.size(); ++i) rows.middleCols<3>(3 * i) += cardinal[i] * defect;
  return rows;
}

void GeneralRows::ring_polynomials(std::vector<double> const& t, MatrixXd& even, MatrixXd& odd) const {
  int const n = order_ + 1;
  MatrixXd legendre(n, t.size());
  for (std::size_t s = 0; s < t.size(); ++s) legendre_polynomials(std::cos(t[s]), order_, legendre.col(s).data());
  even = legendre.transpose() * nodes_to_legendre_;
  odd = even;
  for (std::size_t s = 0; s < t.size(); ++s)
    for (int j = 0; j < n; ++j) odd(s, j) *= std::sin(t[s]) / std::sin(surface_.grid().polar_angles()[j]);
}

NodeRows GeneralRows::to_nodes(std::vector<double> const& t, MatrixXd const& modal) const {
  int const n_ring = order_ + 1, n_azimuth = 2 * n_ring, n_column = 2 * order_ + 1;
  MatrixXd even, odd;
  ring_polynomials(t, even, odd);
  MatrixXd const by_even = even.transpose() * modal, by_odd = odd.transpose() * modal;  // [ring, (entry, column)]
  NodeRows rows(3, 3 * n_ring * n_azimuth);
  MatrixXd coefficients(n_ring, n_column);
  for (int e = 0; e < n_entry; ++e) {
    for (int c = 0; c < n_column; ++c)
      coefficients.col(c) = (mode_of_column(c, order_) % 2 ? by_odd : by_even).col(e * n_column + c);
    MatrixXd const values = coefficients * modes_to_nodes_;  // [ring, azimuth]
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k)
        if (entry_of[i][k] == e)
          for (int j = 0; j < n_ring; ++j)
            for (int a = 0; a < n_azimuth; ++a) rows(i, 3 * (j * n_azimuth + a) + k) = values(j, a);
  }
  return rows;
}

Eigen::VectorXd GeneralRows::cardinal_functions(double t, double phi) const {
  int const n_ring = order_ + 1, n_azimuth = 2 * n_ring, n_column = 2 * order_ + 1;
  MatrixXd even, odd, basis(1, n_column);
  ring_polynomials({t}, even, odd);
  trigonometric_row(phi, order_, basis, 0);
  Eigen::VectorXd values = Eigen::VectorXd::Zero(n_ring * n_azimuth);
  for (int c = 0; c < n_column; ++c) {
    auto const& ring = mode_of_column(c, order_) % 2 ? odd : even;
    for (int j = 0; j < n_ring; ++j)
      for (int a = 0; a < n_azimuth; ++a) values[j * n_azimuth + a] += ring(0, j) * basis(0, c) * modes_to_nodes_(c, a);
  }
  return values;
}

}  // namespace asterflow

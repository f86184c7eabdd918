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

// Columns 1, cos phi ... cos p phi, sin phi ... sin p phi, from those of 1.
void fill_trigonometric(int order, MatrixXd& basis) {
  basis.col(0).setOnes();
  auto const c1 = basis.col(1).array(), s1 = basis.col(order + 1).array();
  for (int m = 1; m < order; ++m) {
    auto const c = basis.col(m).array(), s = basis.col(order + m).array();
    basis.col(m + 1).array() = c * c1 - s * s1;
    basis.col(order + m + 1).array() = s * c1 + c * s1;
  }
}

MatrixXd trigonometric(std::vector<double> const& phi, int order) {
  MatrixXd basis(phi.size(), 2 * order + 1);
  for (std::size_t k = 0; k < phi.size(); ++k) {
    basis(k, 1) = std::cos(phi[k]);
    basis(k, order + 1) = std::sin(phi[k]);
  }
  fill_trigonometric(order, basis);
  return basis;
}

int mode_of_column(int column, int order) { return column <= order ? column : column - order; }

}  // namespace

GeneralRows::GeneralRows(Surface const& surface, double digits)
    : surface_(surface), order_(surface.order()), n_ring_(surface.grid().n_ring()), digits_(digits) {
  auto const& grid = surface.grid();
  int const n_azimuth = grid.n_azimuth();
  nodes_to_legendre_.resize(n_ring_, n_ring_);
  std::vector<double> values(n_ring_);
  for (int j = 0; j < n_ring_; ++j) {
    legendre_polynomials(std::cos(grid.polar_angles()[j]), n_ring_ - 1, values.data());
    for (int l = 0; l < n_ring_; ++l) nodes_to_legendre_(l, j) = grid.ring_weights()[j] * (l + 0.5) * values[l];
  }
  std::vector<double> phi;
  for (int k = 0; k < n_azimuth; ++k) phi.push_back(grid.azimuth(k));
  modes_to_nodes_ = 2.0 / n_azimuth * trigonometric(phi, order_).transpose();
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

// Work space of one ring of the quadrature.
struct GeneralRows::Ring {
  std::vector<RulePoint> rule;
  Eigen::ArrayXd cosines, sines, weights, factor;
  Surface::RingSample sample;
  MatrixXd basis, kernel;  // [point, 2 p + 1], [point, entry]
};

// Kernel entries against all trigonometric functions of one ring: [2 p + 1, entry].
void GeneralRows::integrate_ring(Vec3d target, Grading::PolarAngle angle, double weight, Ring& ring,
                                 Eigen::Ref<MatrixXd> result) const {
  auto const n = static_cast<Eigen::Index>(ring.rule.size());
  ring.cosines.resize(n);
  ring.sines.resize(n);
  ring.weights.resize(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    ring.cosines[k] = std::cos(ring.rule[k].x);
    ring.sines[k] = std::sin(ring.rule[k].x);
    ring.weights[k] = ring.rule[k].weight;
  }
  surface_.sample_ring(angle, ring.cosines, ring.sines, ring.sample);
  Shape::Columns& r = ring.sample.positions;  // becomes y - target: the kernel is even but for the flux
  Shape::Columns const& area = ring.sample.areas;
  for (int i = 0; i < 3; ++i) r.col(i) -= target[i];
  ring.factor = r.square().rowwise().sum();
  ring.factor = (ring.factor > 0.0).select(ring.factor.inverse(), 0.0);  // crowded nodes: the rule may meet the target
  ring.factor *= ring.factor * ring.factor.sqrt();
  ring.factor *= 3.0 / (4.0 * pi) * weight * ring.weights * (r * area).rowwise().sum();
  ring.kernel.resize(n, n_entry);
  for (int i = 0; i < 3; ++i)
    for (int k = i; k < 3; ++k) ring.kernel.col(entry_of[i][k]).array() = ring.factor * r.col(i) * r.col(k);
  ring.basis.resize(n, 2 * order_ + 1);
  ring.basis.col(1) = ring.cosines;
  ring.basis.col(order_ + 1) = ring.sines;
  fill_trigonometric(order_, ring.basis);
  result.noalias() = ring.basis.transpose() * ring.kernel;
}

NodeRows GeneralRows::integrate(Vec3d target, Singularity const& near) const {
  int const n_column = 2 * order_ + 1;
  double const stretch = norm(surface_.patch(near.t, near.phi).tangent_t);
  std::vector<RulePoint> meridian;
  append_graded_rule(0.0, near.t, pi, near.distance / stretch, {digits_, n_ring_ + 1.0}, meridian);

  MatrixXd modal(n_entry * n_column, meridian.size());
  std::vector<double> t;
  Ring ring;
  for (std::size_t s = 0; s < meridian.size(); ++s) {
    t.push_back(meridian[s].x);
    Grading::PolarAngle const angle = surface_.grading().polar_angle(t.back());
    double const centre = closest_azimuth(target, angle, near.phi);
    SurfacePatch const closest = surface_.patch(angle, centre);
    double const speed = norm(closest.tangent_phi), gap = norm(target - closest.position);
    periodic_rule(centre, gap > 10.0 * speed ? 10.0 : gap / speed, {digits_, order_ + 2.0}, ring.rule);
    integrate_ring(target, angle, meridian[s].weight, ring, Eigen::Map<MatrixXd>(modal.col(s).data(), n_column, n_entry));
  }
  NodeRows rows = to_nodes(t, modal.transpose());
  Eigen::Matrix3d defect = near.jump * Eigen::Matrix3d::Identity();
  for (Eigen::Index i = 0; i < rows.cols(); i += 3) defect -= rows.middleCols<3>(i);
  Eigen::VectorXd const cardinal = cardinal_functions(near.t, near.phi);
  for (Eigen::Index i = 0; i < cardinal.size(); ++i) rows.middleCols<3>(3 * i) += cardinal[i] * defect;
  return rows;
}

void GeneralRows::ring_polynomials(std::vector<double> const& t, MatrixXd& even, MatrixXd& odd) const {
  MatrixXd legendre(n_ring_, t.size());
  for (std::size_t s = 0; s < t.size(); ++s) legendre_polynomials(std::cos(t[s]), n_ring_ - 1, legendre.col(s).data());
  even = legendre.transpose() * nodes_to_legendre_;
  odd = even;
  for (std::size_t s = 0; s < t.size(); ++s)
    for (int j = 0; j < n_ring_; ++j) odd(s, j) *= std::sin(t[s]) / std::sin(surface_.grid().polar_angles()[j]);
}

NodeRows GeneralRows::to_nodes(std::vector<double> const& t, MatrixXd const& modal) const {
  int const n_azimuth = surface_.grid().n_azimuth(), n_column = 2 * order_ + 1;
  MatrixXd even, odd;
  ring_polynomials(t, even, odd);
  MatrixXd const by_even = even.transpose() * modal, by_odd = odd.transpose() * modal;  // [ring, (entry, column)]
  NodeRows rows(3, 3 * n_ring_ * n_azimuth);
  MatrixXd coefficients(n_ring_, n_column);
  for (int e = 0; e < n_entry; ++e) {
    for (int c = 0; c < n_column; ++c)
      coefficients.col(c) = (mode_of_column(c, order_) % 2 ? by_odd : by_even).col(e * n_column + c);
    MatrixXd const values = coefficients * modes_to_nodes_;  // [ring, azimuth]
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k)
        if (entry_of[i][k] == e)
          for (int j = 0; j < n_ring_; ++j)
            for (int a = 0; a < n_azimuth; ++a) rows(i, 3 * (j * n_azimuth + a) + k) = values(j, a);
  }
  return rows;
}

Eigen::VectorXd GeneralRows::cardinal_functions(double t, double phi) const {
  int const n_azimuth = surface_.grid().n_azimuth(), n_column = 2 * order_ + 1;
  MatrixXd even, odd;
  MatrixXd const basis = trigonometric({phi}, order_);
  ring_polynomials({t}, even, odd);
  Eigen::VectorXd values = Eigen::VectorXd::Zero(n_ring_ * n_azimuth);
  for (int c = 0; c < n_column; ++c) {
    auto const& ring = mode_of_column(c, order_) % 2 ? odd : even;
    for (int j = 0; j < n_ring_; ++j)
      for (int a = 0; a < n_azimuth; ++a) values[j * n_azimuth + a] += ring(0, j) * basis(0, c) * modes_to_nodes_(c, a);
  }
  return values;
}

}  // namespace asterflow

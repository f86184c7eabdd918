#include "surface/double_layer.hpp"

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "surface/point_load.hpp"

#include <cmath>
#include <numbers>

namespace asterflow {
namespace {

constexpr double pi = std::numbers::pi;

}  // namespace

DoubleLayer::DoubleLayer(Surface surface, Side side, double digits) : surface_(std::move(surface)), side_(side) {
  if (!surface_.axisymmetric()) {
    nodes_ = std::make_unique<GeneralRows>(surface_, digits);
    auto const n = static_cast<long>(surface_.size());
    matrix_.resize(3 * n, 3 * n);
    parallel_for("DoubleLayer::nodes", n, [&](long i) { matrix_.middleRows<3>(3 * i) = nodes_->on_surface(i); });
    return;
  }
  modes_ = std::make_unique<ModalBoundary>(surface_, side, digits);
  inverses_.resize(modes_->n_mode());
  parallel_for("DoubleLayer::modes", modes_->n_mode(),
               [&](long m) { inverses_[m].compute(modes_->equation(static_cast<int>(m))); });
}

NodeRows DoubleLayer::rows(Vec3d target) const {
  if (nodes_) return nodes_->at(target);
  Vec3d const x = surface_.to_polar(target);
  return expand(modes_->rows().at({x.x, std::hypot(x.y, x.z)}), std::atan2(x.z, x.y));
}

// Rows of the modes at azimuth phi -> rows of the nodes in Cartesian components. With d = phi - phi_k, mode m
// contributes cos(m d) where the target's and the source's component have the same parity in phi, else +-sin(m d).
NodeRows DoubleLayer::expand(ModalRowSet const& modal, double phi) const {
  int const n_ring = modes_->n_ring(), n = surface_.grid().n_azimuth();
  Eigen::Matrix3d const frame = surface_.grading().frame();
  Eigen::Matrix3d target_frame = Eigen::Matrix3d::Identity(), source_frame = target_frame;  // cylindrical -> polar Cartesian
  target_frame.bottomRightCorner<2, 2>() << std::cos(phi), -std::sin(phi), std::sin(phi), std::cos(phi);
  NodeRows rows(3, 3 * n_ring * n);
  for (int k = 0; k < n; ++k) {
    double const source_phi = surface_.grid().azimuth(k), d = phi - source_phi;
    source_frame.bottomRightCorner<2, 2>() << std::cos(source_phi), -std::sin(source_phi), std::sin(source_phi), std::cos(source_phi);
    NodeRows sum = NodeRows::Zero(3, 3 * n_ring);
    for (int m = 0; m < modes_->n_mode(); ++m) {
      double const weight = (m == 0 ? 1.0 : 2.0) / n, c = weight * std::cos(m * d), s = weight * std::sin(m * d);
      sum.topLeftCorner(2, 2 * n_ring) += c * modal[m].topLeftCorner(2, 2 * n_ring);
      sum.topRightCorner(2, n_ring) += s * modal[m].topRightCorner(2, n_ring);
      sum.bottomLeftCorner(1, 2 * n_ring) -= s * modal[m].bottomLeftCorner(1, 2 * n_ring);
      sum.bottomRightCorner(1, n_ring) += c * modal[m].bottomRightCorner(1, n_ring);
    }
    Eigen::Matrix3d const to_target = frame * target_frame, from_source = (frame * source_frame).transpose();
    for (int j = 0; j < n_ring; ++j) {
      Eigen::Matrix3d block;
      block << sum.col(j), sum.col(n_ring + j), sum.col(2 * n_ring + j);
      rows.middleCols<3>(3 * (j * n + k)) = to_target * block * from_source;
    }
  }
  return rows;
}

void DoubleLayer::apply(ConstPoints q, Points v) const {
  double const jump = side_ == Side::interior ? 0.5 : -0.5;
  if (modes_) {
    apply_modes(q, v);
    return;
  }
  flat(v).noalias() = matrix_ * flat(q);
  flat(v) += jump * flat(q);
  if (side_ == Side::interior) {
    double flux = 0.0;
    for (std::size_t i = 0; i < q.size(); ++i) flux += surface_.weights()[i] * dot(surface_.normals()[i], q[i]);
    for (std::size_t i = 0; i < q.size(); ++i) v[i] += flux / surface_.area() * surface_.normals()[i];
  } else {
    Load const total = load(q);
    for (std::size_t i = 0; i < q.size(); ++i) v[i] += velocity_of_load(total, surface_.nodes()[i]);
  }
}

Eigen::MatrixXd DoubleLayer::equation() const {
  auto const n = static_cast<Eigen::Index>(surface_.size());
  if (nodes_ && side_ == Side::exterior) {
    PointLoad const completion(surface_);
    Eigen::MatrixXd velocities(3 * n, 6);
    for (Eigen::Index i = 0; i < n; ++i) velocities.middleRows<3>(3 * i) = completion.velocity(surface_.nodes()[i]);
    Eigen::MatrixXd matrix = matrix_ + velocities * completion.rows();
    matrix.diagonal().array() -= 0.5;
    return matrix;
  }
  if (nodes_) {
    Eigen::VectorXd const normals = flat(surface_.normals());
    Eigen::VectorXd fluxes = normals / surface_.area();
    for (Eigen::Index i = 0; i < n; ++i) fluxes.segment<3>(3 * i) *= surface_.weights()[i];
    Eigen::MatrixXd matrix = matrix_ + normals * fluxes.transpose();
    matrix.diagonal().array() += 0.5;
    return matrix;
  }
  Eigen::MatrixXd matrix(3 * n, 3 * n);
  parallel_for("DoubleLayer::equation", 3 * n, [&](long column) {
    PointArray unit(surface_.size()), image(surface_.size());
    flat(Points(unit))[column] = 1.0;
    apply_modes(unit, image);
    matrix.col(column) = flat(ConstPoints(image));
  });
  return matrix;
}

// The modes do not hold the highest cosine of the grid; on it the operator is taken as its jump alone.
void DoubleLayer::apply_modes(ConstPoints q, Points v) const {
  double const jump = side_ == Side::interior ? 0.5 : -0.5;
  std::vector<ModalBoundary::Mode> modes = modes_->analyse(q);
  modes_->synthesise(modes, v);
  PointArray rest(q.size());
  for (std::size_t i = 0; i < q.size(); ++i) rest[i] = jump * (q[i] - v[i]);
  for (int m = 0; m < modes_->n_mode(); ++m) modes[m] = (modes_->equation(m) * modes[m]).eval();
  modes_->synthesise(modes, v);
  for (std::size_t i = 0; i < q.size(); ++i) v[i] += rest[i];
}

void DoubleLayer::precondition(ConstPoints v, Points q) const {
  double const inverse_jump = side_ == Side::interior ? 2.0 : -2.0;
  if (!modes_) {
    flat(q) = inverse_jump * flat(v);
    return;
  }
  std::vector<ModalBoundary::Mode> modes = modes_->analyse(v);
  modes_->synthesise(modes, q);
  PointArray rest(q.size());
  for (std::size_t i = 0; i < q.size(); ++i) rest[i] = inverse_jump * (v[i] - q[i]);
  for (int m = 0; m < modes_->n_mode(); ++m) modes[m] = inverses_[m].solve(modes[m]).eval();
  modes_->synthesise(modes, q);
  for (std::size_t i = 0; i < q.size(); ++i) q[i] += rest[i];
}

DoubleLayer::Load DoubleLayer::load(ConstPoints q) const {
  double const factor = -2.0 / std::sqrt(surface_.area() / (4.0 * pi));
  Load total{};
  for (std::size_t i = 0; i < q.size(); ++i) {
    Vec3d const force = factor * surface_.weights()[i] * q[i];
    total[0] += force;
    total[1] += cross(surface_.nodes()[i] - surface_.shape().centre(), force);
  }
  return total;
}

Vec3d DoubleLayer::velocity_of_load(Load const& load, Vec3d target) const {
  Vec3d const r = target - surface_.shape().centre();
  double const inverse = 1.0 / norm(r), cube = inverse * inverse * inverse;
  return 1.0 / (8.0 * pi) * (inverse * load[0] + cube * (dot(r, load[0]) * r + cross(load[1], r)));
}

}  // namespace asterflow

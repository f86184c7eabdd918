#include "surface/point_load.hpp"

#include <cmath>
#include <numbers>

namespace asterflow {
namespace {

Eigen::Matrix3d cross_matrix(Vec3d a) {
  Eigen::Matrix3d m;
  m << 0, -a.z, a.y, a.z, 0, -a.x, -a.y, a.x, 0;
  return m;
}

}  // namespace

PointLoad::PointLoad(Surface const& surface) : surface_(surface) {}

Eigen::MatrixXd PointLoad::rows() const {
  auto const n = static_cast<Eigen::Index>(surface_.size());
  Eigen::MatrixXd rows(6, 3 * n);
  double const factor = -2.0 / std::sqrt(surface_.area() / (4.0 * std::numbers::pi));
  for (Eigen::Index i = 0; i < n; ++i) {
    double const weight = factor * surface_.weights()[i];
    rows.block<3, 3>(0, 3 * i) = weight * Eigen::Matrix3d::Identity();
    rows.block<3, 3>(3, 3 * i) = weight * cross_matrix(surface_.nodes()[i] - surface_.shape().centre());
  }
  return rows;
}

Eigen::Matrix<double, 3, 6> PointLoad::velocity(Vec3d x) const {
  Vec3d const r = x - surface_.shape().centre();
  Eigen::Vector3d const arm(r.x, r.y, r.z);
  double const inverse = 1.0 / arm.norm(), cube = inverse * inverse * inverse;
  Eigen::Matrix<double, 3, 6> velocity;
  velocity.leftCols<3>() = inverse * Eigen::Matrix3d::Identity() + cube * arm * arm.transpose();
  velocity.rightCols<3>() = -cube * cross_matrix(r);  // T x r
  return velocity / (8.0 * std::numbers::pi);
}

}  // namespace asterflow

#include "surface/general_dirichlet.hpp"

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "surface/double_layer.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace asterflow {
namespace {

using Eigen::MatrixXd;

// Force and torque of a density as rows, and their velocity at a point as columns.
MatrixXd load_rows(DoubleLayer const& layer) {
  std::size_t const n = layer.surface().size();
  MatrixXd rows(6, 3 * n);
  PointArray unit(n);
  for (std::size_t i = 0; i < n; ++i)
    for (int c = 0; c < 3; ++c) {
      unit[i][c] = 1.0;
      auto const load = layer.load(unit);
      rows.col(static_cast<Eigen::Index>(3 * i) + c) << load[0].x, load[0].y, load[0].z, load[1].x, load[1].y, load[1].z;
      unit[i] = {};
    }
  return rows;
}

Eigen::Matrix<double, 3, 6> load_velocity(DoubleLayer const& layer, Vec3d x) {
  Eigen::Matrix<double, 3, 6> result;
  for (int c = 0; c < 6; ++c) {
    DoubleLayer::Load load{};
    load[c / 3][c % 3] = 1.0;
    Vec3d const u = layer.velocity_of_load(load, x);
    result.col(c) << u.x, u.y, u.z;
  }
  return result;
}

}  // namespace

GeneralDirichlet::GeneralDirichlet(Surface const& surface, Side side, int n_shell, double accuracy)
    : surface_(surface), side_(side), n_shell_(n_shell), transform_(surface.grid().n_azimuth()) {
  DoubleLayer const layer(surface, side, std::clamp(1.5 - std::log10(accuracy), 4.0, 13.0));
  auto const n = static_cast<Eigen::Index>(surface.size());
  MatrixXd equation(3 * n, 3 * n);
  PointArray unit(surface.size()), image(surface.size());
  for (Eigen::Index i = 0; i < 3 * n; ++i) {
    flat(Points(unit))[i] = 1.0;
    layer.apply(unit, image);
    equation.col(i) = flat(ConstPoints(image));
    flat(Points(unit))[i] = 0.0;
  }
  MatrixXd const loads = side == Side::exterior ? load_rows(layer) : MatrixXd::Zero(6, 3 * n);
  Eigen::PartialPivLU<MatrixXd> const inverse(equation.transpose());
  shells_ = inverse.solve(shell_rows(layer, loads));
  loads_ = inverse.solve(loads.transpose()).transpose();
}

MatrixXd GeneralDirichlet::shell_rows(DoubleLayer const& layer, MatrixXd const& loads) const {
  auto const n = static_cast<long>(surface_.size());
  MatrixXd rows(3 * n, 3 * n * (n_shell_ - 1));
  parallel_for("GeneralDirichlet::shells", n * (n_shell_ - 1), [&](long column) {
    int const k = 1 + static_cast<int>(column / n);
    Vec3d const centre = surface_.shape().centre(), arm = surface_.nodes()[column % n] - centre;
    double const scale = shell_scale(k, n_shell_);
    NodeRows u = NodeRows::Zero(3, 3 * n);
    if (side_ == Side::interior) {
      u = layer.rows(centre + scale * arm);
    } else if (scale == 0.0) {  // infinity: the Stokeslet alone falls as s
      u = load_velocity(layer, centre + arm).leftCols<3>() * loads.topRows<3>();
    } else {
      Vec3d const x = centre + 1.0 / scale * arm;
      u = 1.0 / scale * (layer.rows(x) + load_velocity(layer, x) * loads);
    }
    rows.middleCols<3>(3 * column) = u.transpose();
  });
  return rows;
}

void GeneralDirichlet::shell_modes(ConstPoints boundary_velocity, std::vector<ShellMode>& modes) const {
  auto const n = static_cast<Eigen::Index>(surface_.size());
  int const n_ring = surface_.grid().n_ring();
  modes.resize(n_ring);
  for (auto& mode : modes) mode.resize(3 * n_ring * n_shell_, 2);
  parallel_for("GeneralDirichlet::shell_modes", n_shell_, [&](long k) {
    PointArray shell(boundary_velocity.begin(), boundary_velocity.end());  // shell 0: the data
    if (k > 0) flat(Points(shell)).noalias() = shells_.middleCols(3 * n * (k - 1), 3 * n).transpose() * flat(boundary_velocity);
    std::vector<RingMode> const rings = analyse_modes(surface_, transform_, shell);
    for (int m = 0; m < n_ring; ++m) modes[m].middleRows(3 * n_ring * k, 3 * n_ring) = rings[m];
  });
}

Eigen::Matrix<double, 6, 1> GeneralDirichlet::load(ConstPoints boundary_velocity) const {
  ASTERFLOW_REQUIRE(side_ == Side::exterior);
  Eigen::Matrix<double, 6, 1> const load = loads_ * flat(boundary_velocity);
  Vec3d const force = surface_.to_polar({load[0], load[1], load[2]}), torque = surface_.to_polar({load[3], load[4], load[5]});
  return {force.x, force.y, force.z, torque.x, torque.y, torque.z};
}

std::size_t GeneralDirichlet::memory() const { return sizeof(double) * static_cast<std::size_t>(shells_.size() + loads_.size()); }

}  // namespace asterflow

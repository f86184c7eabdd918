#include "surface/general_dirichlet.hpp"

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "surface/general_rows.hpp"
#include "surface/modal_boundary.hpp"
#include "surface/point_load.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace asterflow {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Turns every 3 x 3 block of rows into components along (e_1, e_2, e_3), of input and output.
NodeRows in_polar_components(Eigen::Matrix3d const& frame, NodeRows const& rows) {
  NodeRows turned(3, rows.cols());
  for (Eigen::Index i = 0; i < rows.cols(); i += 3)
    turned.middleCols<3>(i) = frame.transpose() * rows.middleCols<3>(i) * frame;
  return turned;
}

MatrixXd in_polar_components_of_input(Eigen::Matrix3d const& frame, MatrixXd const& rows) {
  MatrixXd turned(rows.rows(), rows.cols());
  for (Eigen::Index i = 0; i < rows.cols(); i += 3) turned.middleCols<3>(i) = rows.middleCols<3>(i) * frame;
  return turned;
}

}  // namespace

GeneralDirichlet::GeneralDirichlet(Surface const& surface, Side side, int n_shell, double accuracy, Matrices matrices)
    : surface_(surface), side_(side), n_shell_(n_shell), classes_(surface), transform_(surface.grid().n_azimuth()),
      matrices_(std::move(matrices)) {
  if (matrices_.empty()) assemble(accuracy);
}

void GeneralDirichlet::assemble(double accuracy) {
  GeneralRows const rows(surface_, std::clamp(1.5 - std::log10(accuracy), 4.0, 13.0));
  PointLoad const completion(surface_);
  auto const n = static_cast<Eigen::Index>(3 * surface_.size());
  Eigen::Matrix3d const frame = surface_.grading().frame();
  bool const is_inside = side_ == Side::interior;
  MatrixXd const loads_of_density = is_inside ? MatrixXd::Zero(6, n) : completion.rows();
  VectorXd const normals = flat(surface_.normals());
  VectorXd fluxes = normals / surface_.area();
  for (Eigen::Index i = 0; i < n; ++i) fluxes[i] *= surface_.weights()[i / 3];

  // Row 0 of each representative is the boundary equation, row k its velocity on shell k.
  std::size_t const n_representative = classes_.representatives().size();
  std::array<MatrixXd, MirrorClasses::count> equations;
  matrices_.assign(2 * MirrorClasses::count, {});
  for (int s = 0; s < MirrorClasses::count; ++s) {
    equations[s].resize(classes_.size(s), classes_.size(s));
    matrices_[s].resize(classes_.size(s), classes_.size(s) * (n_shell_ - 1));
  }
  auto const row_at = [&](std::size_t node, int k) -> NodeRows {
    Vec3d const centre = surface_.shape().centre(), x = surface_.nodes()[node], arm = x - centre;
    if (k == 0) {
      NodeRows u = rows.on_surface(node);
      auto const first = static_cast<Eigen::Index>(3 * node);
      u.middleCols<3>(first).diagonal().array() += is_inside ? 0.5 : -0.5;
      if (is_inside)
        u += normals.segment<3>(first) * fluxes.transpose();
      else
        u += completion.velocity(x) * loads_of_density;
      return u;
    }
    double const scale = shell_scale(k, n_shell_);
    if (is_inside) return rows.at(centre + scale * arm);
    if (scale == 0.0)  // infinity: the Stokeslet alone falls as s
      return completion.velocity(x).leftCols<3>() * loads_of_density.topRows<3>();
    Vec3d const y = centre + 1.0 / scale * arm;
    return 1.0 / scale * (rows.at(y) + completion.velocity(y) * loads_of_density);
  };
  parallel_for("GeneralDirichlet::rows", static_cast<long>(n_representative) * n_shell_, [&](long i) {
    int const k = static_cast<int>(i % n_shell_);
    auto const r = static_cast<std::size_t>(i / n_shell_);
    NodeRows const u = in_polar_components(frame, row_at(node_of(r), k));
    for (int s = 0; s < MirrorClasses::count; ++s) {
      auto const folded = classes_.fold(s, r, u);
      for (int c = 0; c < 3; ++c) {
        Eigen::Index const index = classes_.index(s, r, c);
        if (index < 0) continue;
        if (k == 0)
          equations[s].row(index) = folded.row(c);
        else
          matrices_[s].col(classes_.size(s) * (k - 1) + index) = folded.row(c).transpose();
      }
    }
  });
  MatrixXd const loads = in_polar_components_of_input(frame, loads_of_density);
  parallel_for("GeneralDirichlet::solve", MirrorClasses::count, [&](long i) {
    int const s = static_cast<int>(i);
    Eigen::PartialPivLU<MatrixXd> const inverse(equations[s].transpose());
    matrices_[s] = inverse.solve(matrices_[s]).eval();
    matrices_[MirrorClasses::count + s] = inverse.solve(classes_.fold_functionals(s, loads).transpose()).transpose();
  });
}

PointArray GeneralDirichlet::to_polar(ConstPoints field) const {
  PointArray turned(field.size());
  for (std::size_t i = 0; i < field.size(); ++i) turned[i] = surface_.to_polar(field[i]);
  return turned;
}

void GeneralDirichlet::shell_modes(ConstPoints boundary_velocity, std::vector<ShellMode<double>>& modes) const {
  int const n_ring = surface_.grid().n_ring(), n_mode = surface_.grid().n_mode();
  PointArray const data = to_polar(boundary_velocity);
  std::array<VectorXd, MirrorClasses::count> coefficients;
  for (int s = 0; s < MirrorClasses::count; ++s) coefficients[s] = classes_.analyse(s, data);
  modes.resize(n_mode);
  for (auto& mode : modes) mode.resize(3 * n_ring * n_shell_, 2);
  parallel_for("GeneralDirichlet::shell_modes", n_shell_, [&](long k) {
    PointArray shell(boundary_velocity.begin(), boundary_velocity.end());  // shell 0: the data
    if (k > 0) {
      std::ranges::fill(shell, Vec3d{});
      for (int s = 0; s < MirrorClasses::count; ++s) {
        auto const size = classes_.size(s);
        VectorXd const u = shells(s).middleCols(size * (k - 1), size).transpose() * coefficients[s];
        classes_.add_synthesis(s, u, shell);
      }
      for (Vec3d& u : shell) u = surface_.from_polar(u);
    }
    std::vector<RingMode> const rings = analyse_modes(surface_, transform_, shell);
    for (int m = 0; m < n_mode; ++m) modes[m].middleRows(3 * n_ring * k, 3 * n_ring) = rings[m];
  });
}

void GeneralDirichlet::shell_modes(ConstPoints boundary_velocity, std::vector<ShellMode<float>>& modes) const {
  std::vector<ShellMode<double>> exact;
  shell_modes(boundary_velocity, exact);
  modes.resize(exact.size());
  for (std::size_t m = 0; m < modes.size(); ++m) modes[m] = exact[m].cast<float>();
}

Eigen::Matrix<double, 6, 1> GeneralDirichlet::load(ConstPoints boundary_velocity) const {
  ASTERFLOW_REQUIRE(side_ == Side::exterior);
  PointArray const data = to_polar(boundary_velocity);
  Eigen::Matrix<double, 6, 1> load = Eigen::Matrix<double, 6, 1>::Zero();
  for (int s = 0; s < MirrorClasses::count; ++s) load += loads(s) * classes_.analyse(s, data);
  Vec3d const force = surface_.to_polar({load[0], load[1], load[2]}), torque = surface_.to_polar({load[3], load[4], load[5]});
  return {force.x, force.y, force.z, torque.x, torque.y, torque.z};
}

}  // namespace asterflow

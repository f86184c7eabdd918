#include "surface/boundary_system.hpp"

#include "base/parallel.hpp"
#include "surface/grid_transfer.hpp"
#include "surface/point_load.hpp"

#include <algorithm>
#include <cmath>

namespace asterflow {

using Eigen::MatrixXd;

BoundarySystem::BoundarySystem(std::vector<PlacedSurface> surfaces, CloseSpots const& spots, int order, double accuracy)
    : surfaces_(std::move(surfaces)), order_(order) {
  double const digits = std::clamp(4.0 - std::log10(accuracy), 6.0, 13.0);
  for (std::size_t i = 0; i < surfaces_.size(); ++i) {
    layers_.push_back(std::make_unique<DoubleLayer>(place_nodes(surfaces_[i], spots[i], order),
                                                    surfaces_[i].encloses ? Side::interior : Side::exterior, digits));
    first_.push_back(size_);
    size_ += layers_.back()->surface().size();
  }
  couplings_.resize(count() * count());
  for (std::size_t i = 0; i < count(); ++i)
    for (std::size_t j = 0; j < count(); ++j)
      if (i != j) assemble_coupling(i, j);
}

void BoundarySystem::apply(ConstPoints q, Points v) const {
  for (std::size_t i = 0; i < count(); ++i) {
    layers_[i]->apply(block(q, i), block(v, i));
    for (std::size_t j = 0; j < count(); ++j)
      if (i != j) add_coupling(i, j, block(q, j), block(v, i));
  }
}

void BoundarySystem::precondition(ConstPoints v, Points q) const {
  for (std::size_t i = 0; i < count(); ++i) layers_[i]->precondition(block(v, i), block(q, i));
}

// Velocity of surface `source` at the nodes of surface `target`, both in their own frames.
void BoundarySystem::assemble_coupling(std::size_t target, std::size_t source) {
  MatrixXd& a = couplings_[target * count() + source];
  Surface const& nodes = layers_[target]->surface();
  Eigen::Matrix3d const turn =
      (surfaces_[target].orientation.conjugate() * surfaces_[source].orientation).toRotationMatrix();
  a.resize(3 * layers_[source]->surface().size(), 3 * nodes.size());
  parallel_for("BoundarySystem::couplings", static_cast<long>(nodes.size()), [&](long k) {
    Vec3d const x = surfaces_[source].to_shape(surfaces_[target].to_laboratory(nodes.nodes()[k]));
    a.middleCols<3>(3 * k) = (turn * layers_[source]->rows(x)).transpose();
  });
}

void BoundarySystem::add_coupling(std::size_t target, std::size_t source, ConstPoints q, Points v) const {
  MatrixXd const& a = couplings_[target * count() + source];
  constexpr long chunk = 32;
  auto const n = static_cast<long>(v.size());
  parallel_for("BoundarySystem::add_coupling", (n + chunk - 1) / chunk, [&](long piece) {
    long const first = 3 * piece * chunk, size = std::min<long>(3 * n - first, 3 * chunk);
    flat(v).segment(first, size).noalias() += a.middleCols(first, size).transpose() * flat(q);
  });
  if (surfaces_[source].encloses) return;
  DoubleLayer::Load const load = layers_[source]->load(q);
  for (std::size_t k = 0; k < v.size(); ++k) {
    Vec3d const x = surfaces_[source].to_shape(surfaces_[target].to_laboratory(layers_[target]->surface().nodes()[k]));
    Vec3d const u = surfaces_[source].turn_to_laboratory(layers_[source]->velocity_of_load(load, x));
    v[k] += surfaces_[target].turn_to_shape(u);
  }
}

// Velocities at the nodes of `target` of unit forces and torques at the centre of `source`: [3 n, 6].
MatrixXd BoundarySystem::load_velocities(std::size_t target, std::size_t source) const {
  auto const nodes = layers_[target]->surface().nodes();
  PointLoad const load(layers_[source]->surface());
  Eigen::Matrix3d const turn =
      (surfaces_[target].orientation.conjugate() * surfaces_[source].orientation).toRotationMatrix();
  MatrixXd velocities(3 * nodes.size(), 6);
  for (std::size_t k = 0; k < nodes.size(); ++k)
    velocities.middleRows<3>(static_cast<Eigen::Index>(3 * k)) =
        turn * load.velocity(surfaces_[source].to_shape(surfaces_[target].to_laboratory(nodes[k])));
  return velocities;
}

MatrixXd BoundarySystem::matrix() const {
  auto const n = static_cast<Eigen::Index>(3 * size_);
  MatrixXd matrix(n, n);
  for (std::size_t j = 0; j < count(); ++j) {
    auto const first_column = static_cast<Eigen::Index>(3 * first_[j]);
    auto const columns = static_cast<Eigen::Index>(3 * layers_[j]->surface().size());
    for (std::size_t i = 0; i < count(); ++i) {
      auto const rows = static_cast<Eigen::Index>(3 * layers_[i]->surface().size());
      auto part = matrix.block(static_cast<Eigen::Index>(3 * first_[i]), first_column, rows, columns);
      if (i == j) {
        part = layers_[i]->equation();
        continue;
      }
      part = couplings_[i * count() + j].transpose();
      if (!surfaces_[j].encloses) part.noalias() += load_velocities(i, j) * PointLoad(layers_[j]->surface()).rows();
    }
  }
  return matrix;
}

CoarseCorrection::CoarseCorrection(BoundarySystem const& fine, BoundarySystem const& coarse)
    : fine_(fine), coarse_(coarse), inverse_(coarse.matrix()) {
  SphereGrid const& from = fine.layer(0).surface().grid();
  SphereGrid const& to = coarse.layer(0).surface().grid();
  restriction_ = grid_transfer(from, to);
  prolongation_ = grid_transfer(to, from);
}

void CoarseCorrection::solve_coarse(ConstPoints v, Points q) const { flat(q) = inverse_.solve(flat(v)); }

// v += sign matrix u, component by component
void CoarseCorrection::add_transferred(MatrixXd const& matrix, double sign, ConstPoints u, Points v) {
  using Nodes = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
  Eigen::Map<Nodes const> const from(&u.front().x, static_cast<Eigen::Index>(u.size()), 3);
  Eigen::Map<Nodes> to(&v.front().x, static_cast<Eigen::Index>(v.size()), 3);
  for (int c = 0; c < 3; ++c) to.col(c).noalias() += sign * (matrix * from.col(c));
}

void CoarseCorrection::precondition(ConstPoints v, Points q) const {
  PointArray restricted(coarse_.size()), solved(coarse_.size()), rest(v.begin(), v.end());
  for (std::size_t i = 0; i < fine_.count(); ++i) {
    Points const low = coarse_.block(Points(restricted), i);
    add_transferred(restriction_, 1.0, fine_.block(v, i), low);
    add_transferred(prolongation_, -1.0, low, fine_.block(Points(rest), i));
  }
  solve_coarse(restricted, solved);
  fine_.precondition(rest, q);
  for (std::size_t i = 0; i < fine_.count(); ++i)
    add_transferred(prolongation_, 1.0, coarse_.block(Points(solved), i), fine_.block(q, i));
}

}  // namespace asterflow

#pragma once
// The completed boundary integral equations of several surfaces together (double_layer.hpp), every surface's density in
// its own frame, one after the other, and a two-level preconditioner: the same equations on coarser grids, solved
// exactly, for what those grids hold, and every surface by itself for the rest,
//   M v = P A_c^-1 R v + D^-1 (v - P R v).
// The equations are of the second kind, so the rest couples weakly and the iterations do not depend on gaps or orders.

#include "surface/close_spots.hpp"
#include "surface/double_layer.hpp"

namespace asterflow {

class BoundarySystem {
 public:
  BoundarySystem(std::vector<PlacedSurface> surfaces, CloseSpots const& spots, int order, double accuracy);

  std::size_t size() const { return size_; }  // nodes
  std::size_t count() const { return layers_.size(); }
  int order() const { return order_; }
  DoubleLayer const& layer(std::size_t surface) const { return *layers_[surface]; }
  template <class Array>
  auto block(Array values, std::size_t surface) const {
    return values.subspan(first_[surface], layers_[surface]->surface().size());
  }

  void apply(ConstPoints q, Points v) const;         // overwrites
  void precondition(ConstPoints v, Points q) const;  // each surface by itself; overwrites
  Eigen::MatrixXd matrix() const;                    // of apply: (3 size) x (3 size)

 private:
  void assemble_coupling(std::size_t target, std::size_t source);
  void add_coupling(std::size_t target, std::size_t source, ConstPoints q, Points v) const;
  Eigen::MatrixXd load_velocities(std::size_t target, std::size_t source) const;

  std::vector<PlacedSurface> surfaces_;
  std::vector<std::unique_ptr<DoubleLayer>> layers_;
  std::vector<std::size_t> first_;
  std::vector<Eigen::MatrixXd> couplings_;  // [target, source] transposed: a target node is contiguous
  std::size_t size_ = 0;
  int order_;
};

class CoarseCorrection {
 public:
  // Keeps references.
  CoarseCorrection(BoundarySystem const& fine, BoundarySystem const& coarse);

  void solve_coarse(ConstPoints v, Points q) const;  // on the coarse grid, exactly; overwrites
  void precondition(ConstPoints v, Points q) const;  // on the fine grid; overwrites

 private:
  static void add_transferred(Eigen::MatrixXd const& matrix, double sign, ConstPoints u, Points v);

  BoundarySystem const& fine_;
  BoundarySystem const& coarse_;
  Eigen::PartialPivLU<Eigen::MatrixXd> inverse_;
  Eigen::MatrixXd restriction_, prolongation_;  // of one component on one surface: all have the same order
};

}  // namespace asterflow

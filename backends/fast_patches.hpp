#pragma once
// The far field's plan: every level of the octree as rectangular patches of grid, with their points, tables of
// multipliers and transforms. Made once per geometry.

#include "backends/fast_grid.hpp"
#include "backends/fast_parameters.hpp"
#include "backends/fast_split.hpp"

#include <array>
#include <functional>
#include <map>

namespace asterflow {

template <class Real>
class FarPatches {
 public:
  // Sorts the points of the given ranges into the tiles of a patch.
  using Tiling = std::function<TiledPoints(Patch<Real> const&, PointArray const& points, std::vector<Range> const&)>;

  // Patches of one level, of bounded total size, handled together.
  struct Batch {
    std::size_t first, last;
  };

  // lanes: numbers of a vector; rows of tables are whole vectors. tile_y: see FastLoops.
  FarPatches(FastKernel kernel, FastParameters const& parameters, int lanes, int tile_y, Tiling tiling);

  void set_points(Octree const& tree);

  FastParameters const& parameters() const { return parameters_; }
  GridWindow<Real> const& window() const { return window_; }
  std::vector<Patch<Real>> const& patches() const { return patches_; }
  std::vector<Batch> const& batches() const { return batches_; }

  // To be added to every velocity, which is in units of the root's side. strengths [n_source].
  Vec3d uniform_flow(ConstPoints strengths) const;

  std::size_t memory() const;

 private:
  // The points of a patch to be.
  struct Members {
    std::vector<Range> sources, targets;
    PointBox source_box, target_box;
    void find_boxes(Octree const& tree);
  };

  void add_root_patch(Octree const& tree);
  void add_level_patches(Octree const& tree, int level);
  void tile_points(Octree const& tree, std::size_t first, std::vector<Members> const& members);
  void set_grid(Octree const& tree, Patch<Real>& patch, bool is_root);
  std::shared_ptr<SymbolTable<Real> const> symbol(Patch<Real> const& patch, bool is_root);
  void close_batches(std::size_t first);

  FastKernel kernel_;
  FastParameters parameters_;
  KernelSplit split_;
  int lanes_, tile_y_;
  Tiling tiling_;
  GridWindow<Real> window_;
  std::map<int, LineTransform<Real>> transforms_;
  std::map<std::array<int, 3>, std::shared_ptr<SymbolTable<Real> const>> symbols_;
  double reach_ = 0.0;  // distance up to which the root's kernel is that of free space
  std::vector<Patch<Real>> patches_;
  std::vector<Batch> batches_;
};

extern template class FarPatches<float>;
extern template class FarPatches<double>;

}  // namespace asterflow

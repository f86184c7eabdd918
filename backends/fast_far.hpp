#pragma once
// The smooth part of a split kernel: every level of the octree as rectangular patches of grid, each spread,
// convolved by Fourier transforms and interpolated.

#include "backends/fast_grid.hpp"
#include "backends/fast_parameters.hpp"
#include "backends/fast_split.hpp"

#include <array>
#include <functional>
#include <map>

namespace asterflow {

template <class Real>
class FarField {
 public:
  FarField(FastKernel kernel, FastLoops<Real> const& loops, FastParameters const& parameters, KernelSplit const& split);

  // The tree must outlive the sums.
  void set_points(Octree const& tree);

  // velocity [n_target] += smooth part in units of the root's side, tree order; gradient [n_target, 3] likewise,
  // unless null.
  //   strengths  [n_source], tree order; normals likewise, null for kernels without
  void add(Vec3d const* strengths, Vec3d const* normals, Vec3d* velocity, Vec3d* gradient);

  // Of the sums' working memory, in use or not.
  std::size_t memory() const;

 private:
  // Patches of one level, of bounded total size, handled together.
  struct Batch {
    std::size_t first, last;
    std::vector<long> grid_begin, spectrum_begin;  // of each patch, and the end, in the working memory
  };

  void add_root_patch();
  void add_level_patches(int level);
  void set_grid(Patch<Real>& patch, bool is_root);
  void tile_points(Patch<Real>& patch, std::vector<Range> const& sources, std::vector<Range> const& targets) const;
  std::shared_ptr<SymbolTable<Real> const> symbol(Patch<Real> const& patch, bool is_root);
  void close_batches(std::size_t first);
  void place_work(Batch& batch) const;

  void set_strengths(Vec3d const* strengths, Vec3d const* normals);
  void run(Batch const& batch, Vec3d* velocity, Vec3d* gradient);
  // piece(patch, its number in the batch, item) for count(patch) items of every patch.
  void for_all(Batch const& batch, std::function<long(PatchView<Real> const&)> const& count,
               std::function<void(PatchView<Real> const&, std::size_t, long)> const& piece) const;
  Vec3d uniform_flow(Vec3d const* strengths) const;

  FastKernel kernel_;
  FastLoops<Real> loops_;
  FastParameters parameters_;
  KernelSplit split_;
  int components_;  // of the strengths on the grid: 3; stresslet 6: xx yy zz xy xz yz
  GridWindow<Real> window_;
  std::map<int, LineTransform<Real>> transforms_;
  std::map<std::array<int, 3>, std::shared_ptr<SymbolTable<Real> const>> symbols_;

  Octree const* tree_ = nullptr;
  double reach_ = 0.0;  // distance up to which the root's kernel is that of free space
  std::vector<Patch<Real>> patches_;
  std::vector<PatchView<Real>> views_;  // of patches_
  std::vector<Batch> batches_;
  std::vector<Real> strengths_, grid_, spectrum_;
};

extern template class FarField<float>;
extern template class FarField<double>;

}  // namespace asterflow

#pragma once
// The smooth part of a split kernel on host threads: every patch spread, convolved by Fourier transforms and
// interpolated.

#include "backends/fast_patches.hpp"

#include <functional>

namespace asterflow {

template <class Real>
class FarField {
 public:
  FarField(FastKernel kernel, FastLoops<Real> const& loops, FastParameters const& parameters);

  // The tree must outlive the sums.
  void set_points(Octree const& tree);

  // velocity [n_target] += smooth part in units of the root's side, tree order; gradient [n_target, 3] likewise,
  // unless null.
  //   strengths  [n_source], tree order; normals likewise, null for kernels without
  //   work       [n_work], overwritten
  void add(Vec3d const* strengths, Vec3d const* normals, Vec3d* velocity, Vec3d* gradient, Real* work);
  long n_work() const { return n_work_; }

  std::size_t memory() const;

 private:
  // Patches handled together.
  struct Batch {
    std::size_t first, last;
    std::vector<long> spectrum_begin, grid_begin;  // of each patch in the working memory
  };

  // Tiles of a patch, those with the most points first: one that comes last would keep the other threads waiting.
  struct TileOrder {
    std::vector<std::uint32_t> sources, targets;
  };

  void place_work(Batch& batch);
  void set_strengths(Vec3d const* strengths, Vec3d const* normals);
  void run(Batch const& batch, Vec3d* velocity, Vec3d* gradient, Real* work);
  // piece(patch, its number in the batch, item) for count(patch) items of every patch.
  void for_all(char const* label, Batch const& batch, std::function<long(PatchView<Real> const&)> const& count,
               std::function<void(PatchView<Real> const&, std::size_t, long)> const& piece) const;

  FastKernel kernel_;
  FastLoops<Real> loops_;
  int components_;  // of the strengths on the grid: 3; stresslet 6: xx yy zz xy xz yz
  FarPatches<Real> patches_;
  Octree const* tree_ = nullptr;
  std::vector<PatchView<Real>> views_;  // of the patches
  std::vector<TileOrder> orders_;       // likewise
  std::vector<Batch> batches_;
  std::vector<Real> strengths_;
  long n_work_ = 0;
};

extern template class FarField<float>;
extern template class FarField<double>;

}  // namespace asterflow

#pragma once
// The local part of a split kernel, summed by host threads over the pairs of fast_near_lists.hpp; targets lie in
// vector lanes.

#include "backends/fast_near_lists.hpp"
#include "backends/fast_split.hpp"
#include "backends/workspace.hpp"

#include <vector>

namespace asterflow {

template <class Real>
class NearField {
 public:
  // local, outer: polynomials for cutoff 1, in as many pieces as the loops have; refinement_steps: see FastParameters.
  // gradient: whether gradients will be asked for, which takes an outer part of no terms.
  NearField(FastKernel kernel, FastLoops<Real> const& loops, LocalPart const& local, OuterPart const& outer, int refinement_steps,
            bool gradient);

  // Orders the points of the tree's leaves; the tree must outlive the sums.
  void set_points(Octree& tree);

  // Strengths and normals in the order of the tree's sources; kept until add() is done.
  void set_strengths(Vec3d const* strengths, Vec3d const* normals);

  long n_items() const { return static_cast<long>(lists_.leaves().size()); }

  // velocity [n_target] += the local part in units of the root's side, for the targets of one
  // leaf; tree order. gradient [n_target, 3] likewise, unless null. Reactions are kept in work [n_work],
  void add(long item, Vec3d* velocity, Vec3d* gradient, Real* work) const;
  // and those at one leaf added once all leaves are through.
  void add_reactions(long item, Vec3d* velocity, Real const* work) const;
  long n_work() const { return 4 * lists_.n_place(); }

  std::size_t memory() const;

 private:
  static constexpr bool split_coordinates = sizeof(Real) == 4;

  void make_levels();
  void copy_coordinates();
  template <class Kernel>
  void add_close(NearLists::Leaf const& leaf, Vec3d* velocity, Vec3d* gradient) const;
  template <class Kernel, class Number>
  void add_pair(int level, std::uint32_t source, Number const (&r)[3], double r2, Number const& inverse,
                Number (&u)[3]) const;

  FastKernel kernel_;
  FastLoops<Real> loops_;
  NearLists lists_;
  LocalPart local_;
  OuterPart outer_;
  int refinement_steps_;
  bool gradient_;
  int record_;  // numbers per source: coordinates (float: high and low parts), strength, normal
  std::vector<NearLevel<Real>> levels_;
  std::vector<OuterLevel> outer_levels_;
  Workspace<Real> records_;  // [source, record]
  Vec3d const* strengths_ = nullptr;
  Vec3d const* normals_ = nullptr;
  double velocity_scale_ = 1.0;
};

extern template class NearField<float>;
extern template class NearField<double>;

}  // namespace asterflow

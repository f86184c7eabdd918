#pragma once
// The local part of a split kernel: pairs closer than the cutoff of the coarser of their two leaves. Targets
// lie in vector lanes; each group of targets has the list of sources near it, found once per geometry.

#include "backends/fast_loops.hpp"
#include "backends/fast_split.hpp"
#include "backends/fast_tree.hpp"

#include <vector>

namespace asterflow {

template <class Real>
class NearField {
 public:
  // local: polynomials for cutoff 1; refinement_steps of the hardware's reciprocal square root.
  NearField(FastKernel kernel, FastLoops<Real> const& loops, LocalPart const& local, int refinement_steps);

  // Orders the targets of every leaf into compact groups, then lists their sources. The points are those of
  // the tree in their own units and order.
  void set_points(Octree& tree, ConstPoints sources, ConstPoints targets);

  // Strengths and normals in the order of the tree's sources; kept until add() is done.
  void set_strengths(Vec3d const* strengths, Vec3d const* normals);

  long n_items() const { return static_cast<long>(leaves_.size()); }

  // velocity [n_target] += the local part in units of the root's side, for the targets of one
  // leaf; tree order. gradient [n_target, 3] likewise, unless null.
  void add(long item, Vec3d* velocity, Vec3d* gradient) const;

  double n_pairs() const;  // evaluated per sum
  std::size_t memory() const;

 private:
  static constexpr bool split_coordinates = sizeof(Real) == 4;

  struct Leaf {
    std::vector<NearGroup> groups;
    std::vector<NearSegment> segments;
    std::vector<std::uint16_t> list;   // sources of each segment, from its base
    std::vector<std::uint32_t> close;  // sources too close to a target for float coordinates
    std::vector<int> close_levels;
  };
  struct Candidates {
    int level;
    Range sources;
  };

  void make_levels(int n_level);
  void copy_points(Octree const& tree, ConstPoints sources, ConstPoints targets);
  std::vector<Candidates> candidates(Octree const& tree, int level, Box const& box) const;
  Leaf list_sources(Octree const& tree, int level, Box const& box) const;
  NearQuery query(PointArray const& targets, long first, int n) const;
  void append_near(NearQuery const& query, NearGroup const& group, Candidates const& from, std::size_t first_segment,
                   Leaf& leaf) const;
  void set_close_apart(NearQuery const& query, NearGroup const& group, Candidates const& from, std::uint32_t base,
                       std::size_t first, Leaf& leaf) const;
  bool is_close(long target, int n_target, std::uint32_t source) const;
  template <class Kernel>
  void add_close(Leaf const& leaf, Vec3d* velocity, Vec3d* gradient) const;
  template <class Kernel, class Number>
  void add_pair(int level, std::uint32_t source, Number const (&r)[3], double r2, Number const& inverse,
                Number const& w, Number (&u)[3]) const;

  FastKernel kernel_;
  FastLoops<Real> loops_;
  LocalPart local_;
  int refinement_steps_;
  int record_;  // numbers per source: coordinates (float: high and low parts), strength, normal
  std::vector<NearLevel<Real>> levels_;
  std::vector<Leaf> leaves_;
  std::vector<Real> records_;
  std::vector<float> filter_[3];  // normalised coordinates of the sources, while lists are made
  // Coordinates that are the points' own up to a power of two, so that differences are exact.
  PointArray sources_, targets_;
  Vec3d const* strengths_ = nullptr;
  Vec3d const* normals_ = nullptr;
  double side_ = 1.0;          // of the root in these coordinates, 0.5 ... 1
  double velocity_scale_ = 1.0;
};

extern template class NearField<float>;
extern template class NearField<double>;

}  // namespace asterflow

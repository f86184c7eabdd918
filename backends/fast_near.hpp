#pragma once
// The local part of a split kernel: pairs closer than the cutoff of the coarser of their two leaves. Targets
// lie in vector lanes; each group of targets has the list of sources near it, found once per geometry.

#include "backends/fast_pack.hpp"
#include "backends/fast_split.hpp"
#include "backends/fast_tree.hpp"

#include <string_view>
#include <vector>

namespace asterflow {

template <class Real>
class NearField {
 public:
  // local: polynomials for cutoff 1; refinement_steps of the hardware's reciprocal square root.
  NearField(std::string_view kernel, LocalPart const& local, int refinement_steps);

  // Orders the targets of every leaf into compact groups, then lists their sources. The points are those of
  // the tree in their own units and order.
  void set_points(Octree& tree, ConstPoints sources, ConstPoints targets);

  // Strengths and normals in the order of the tree's sources; kept until add() is done.
  void set_strengths(Vec3d const* strengths, Vec3d const* normals);

  long n_items() const { return static_cast<long>(leaves_.size()); }

  // velocity [n_target] += 8 pi times the local part in units of the root's side, for the targets of one
  // leaf; tree order.
  void add(long item, Vec3d* velocity) const;

  double n_pairs() const;  // evaluated per sum
  std::size_t memory() const;

 private:
  static constexpr int W = lanes<Real>;
  static constexpr bool split_coordinates = sizeof(Real) == 4;

  struct Level {
    Real cutoff2, u_scale;  // u = u_scale r^2 - 1
    std::vector<Real> a, b;
  };
  struct Segment {
    int level;
    long end;  // of its sources in Leaf::sources
  };
  struct Group {
    long target;  // first
    int n_target, segment_end;
    long close_end;  // of its sources in Leaf::close
  };
  struct Leaf {
    std::vector<Group> groups;
    std::vector<Segment> segments;
    std::vector<std::uint32_t> sources;
    std::vector<std::uint32_t> close;  // too close to a target for float coordinates
    std::vector<int> close_levels;
  };
  struct Candidates {
    int level;
    Range sources;
  };

  std::vector<Candidates> candidates(Octree const& tree, int level, Box const& box) const;
  Leaf list_sources(Octree const& tree, int level, Box const& box) const;
  // Appends the sources of `range` whose distance to the box (centre, half) is below `cutoff`, in
  // normalised coordinates; a few beyond it may be included.
  void append_near(Range range, Vec3d const& centre, Vec3d const& half, double cutoff,
                   std::vector<std::uint32_t>& hits) const;
  bool is_close(long target, int n_target, std::uint32_t source) const;
  void copy_points(Octree const& tree, ConstPoints sources, ConstPoints targets);
  void make_levels(int n_level);
  template <class Kernel, int terms>
  void add_leaf(Leaf const& leaf, Vec3d* velocity) const;
  template <class Kernel>
  void add_with_terms(Leaf const& leaf, Vec3d* velocity) const;
  template <class Kernel>
  void add_close(Leaf const& leaf, long begin, Group const& group, Vec3d* velocity) const;

  std::string_view kernel_;
  LocalPart local_;
  int refinement_steps_;
  int record_;  // numbers per source: coordinates (float: high and low parts), strength, normal
  std::vector<Level> levels_;
  std::vector<Leaf> leaves_;
  std::vector<Real> records_;
  std::vector<float> filter_[3];  // normalised coordinates of the sources, for append_near
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

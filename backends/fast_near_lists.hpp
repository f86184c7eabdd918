#pragma once
// Which pairs the near field sums: targets in compact groups, every group with the list of sources within the cutoff
// of the coarser of their two leaves. Made once per geometry.

#include "backends/fast_loops.hpp"
#include "backends/fast_tree.hpp"

#include <vector>

namespace asterflow {

class NearLists {
 public:
  struct Leaf {
    std::vector<NearGroup> groups;
    std::vector<NearSegment> segments;
    std::vector<std::uint16_t> list;   // sources of each segment, from its base
    std::vector<std::uint32_t> close;  // sources too close to a target for float coordinates
    std::vector<int> close_levels;
  };
  using Finder = void(NearQuery const&, long begin, long end, long base, NearFound& found);

  // group_size: targets of a group, at most NearQuery::max_target; find: see FastLoops::list_near.
  NearLists(int group_size, bool sets_close_apart, Finder* find)
      : group_size_(group_size), sets_close_apart_(sets_close_apart), find_(find) {}

  // Orders the targets of every leaf into groups, then lists their sources. The tree must outlive the lists.
  void set_points(Octree& tree);

  std::vector<Leaf> const& leaves() const { return leaves_; }  // those with targets
  int group_size() const { return group_size_; }
  int n_level() const { return static_cast<int>(tree_->boxes().leaves().size()); }

  PointArray const& sources() const { return tree_->sources(); }
  PointArray const& targets() const { return tree_->targets(); }
  double side() const { return tree_->unit_side(); }  // of the root

  std::size_t memory() const;

 private:
  struct Candidates {
    int level;
    Range sources;
  };

  std::vector<Candidates> candidates(int level, Box const& box) const;
  Leaf list_sources(int level, Box const& box) const;
  NearQuery query(long first, int n) const;
  void append_near(NearQuery const& query, NearGroup const& group, Candidates const& from, std::size_t first_segment,
                   Leaf& leaf) const;
  void set_close_apart(NearGroup const& group, int level, std::uint32_t base, NearFound& found, Leaf& leaf) const;
  bool is_close(long target, int n_target, std::uint32_t source) const;

  int group_size_;
  bool sets_close_apart_;
  Finder* find_;
  Octree const* tree_ = nullptr;
  std::vector<Leaf> leaves_;
  std::vector<float> filter_[3];  // normalised coordinates of the sources, while lists are made
};

}  // namespace asterflow

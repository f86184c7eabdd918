#pragma once
// Which pairs the near field sums: targets in compact groups, every group with the list of sources within the cutoff
// of the coarser of their two leaves. Made once per geometry. Where targets are the sources, a pair of points of two groups
// can be listed once for both directions: each target's share in the velocity at the source is then called its reaction.

#include "backends/fast_loops.hpp"
#include "backends/fast_tree.hpp"

#include <span>
#include <vector>

namespace asterflow {

class NearLists {
 public:
  // One way only: in float their coordinates are too close.
  struct ClosePair {
    std::uint32_t target, source;
    int level;
  };
  // Reactions at these sources, all of one leaf, are summed from `place` on, one place per source.
  struct Reactions {
    Range sources;
    long place;
    std::uint32_t leaf;
  };
  struct Leaf {
    Range targets;
    std::vector<NearGroup> groups;
    std::vector<NearSegment> segments;
    std::vector<std::uint16_t> list;   // sources of each segment, from its base
    std::vector<NearSegment> outer_segments;
    std::vector<std::uint16_t> outer_list;
    std::vector<ClosePair> close;
    std::vector<Reactions> reactions;  // of its targets, from first_place on
    long first_place = 0, n_place = 0;
  };
  using Finder = void(NearQuery const&, long begin, long end, long base, NearFound& found);

  // group_size: targets of a group, at most NearQuery::max_target; find: see FastLoops::list_near. inner_reach: of the cutoff; sources
  // farther from all targets of a group are outer ones, unless it is 1.
  NearLists(int group_size, bool sets_close_apart, Finder* find, double inner_reach = 1.0)
      : group_size_(group_size), sets_close_apart_(sets_close_apart), find_(find), inner_reach_(inner_reach) {}

  // Orders the targets of every leaf into groups, then lists their sources. The tree must outlive the lists.
  // lists_once: pairs for both directions, where the targets are the sources.
  void set_points(Octree& tree, bool lists_once);

  std::vector<Leaf> const& leaves() const { return leaves_; }  // those with targets
  // Those of all leaves at the targets of leaf i.
  std::span<Reactions const> reactions_at(long i) const {
    return {reactions_.data() + first_reactions_[i], reactions_.data() + first_reactions_[i + 1]};
  }
  long n_place() const { return leaves_.empty() ? 0 : leaves_.back().first_place + leaves_.back().n_place; }
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
    bool is_mutual;
    long place;                    // of their reactions, once a source is listed, else -1
    std::vector<Reactions> boxes;  // whose sources they are, if mutual
  };

  std::vector<Candidates> candidates(int level, Box const& box) const;
  Leaf list_sources(int level, Box const& box) const;
  NearQuery query(long first, int n) const;
  void append_near(NearQuery& query, NearGroup const& group, Candidates& from, Leaf& leaf) const;
  void append_own(NearQuery& query, NearGroup const& group, int level, Leaf& leaf) const;
  void set_close_apart(NearGroup const& group, int level, std::uint32_t base, NearFound& found, Leaf& leaf) const;
  bool is_close(long target, int n_target, std::uint32_t source) const;
  void gather_reactions();
  void mirror_close_pairs();

  int group_size_;
  bool sets_close_apart_;
  Finder* find_;
  double inner_reach_;
  Octree const* tree_ = nullptr;
  bool lists_once_ = false;
  std::vector<Leaf> leaves_;
  std::vector<std::vector<std::uint32_t>> leaf_of_box_;  // [level, box] among leaves_, where it has targets
  std::vector<Reactions> reactions_;     // by leaf they act on
  std::vector<long> first_reactions_;    // [n_leaf + 1]
  std::vector<float> filter_[3];  // normalised coordinates of the sources, while lists are made
};

}  // namespace asterflow

#pragma once
// The octrees of every capacity over the same points in the same root, as one: an octree of larger leaves has some of the
// refined boxes of one of smaller leaves, so that it is enough to know up to which capacity each box is refined. For
// the comparison of octrees, which looks at each box many times: boxes know those around them by number.

#include "backends/fast_boxes.hpp"

namespace asterflow {

// One octree of them: OctreeBoxes of the same capacity and first level has the same boxes.
struct OctreeChoice {
  long capacity;
  int first_level;
};

class NestedOctrees {
 public:
  struct Level {
    std::vector<Box> boxes;             // of the octree of the smallest leaves, refined or not, by key
    std::vector<long> refined_below;    // [box] twice the capacity, below which they are refined,
    std::vector<long> exist_below;      // and below which their parents are
    std::vector<std::array<std::int32_t, 27>> around;  // itself and its neighbours in `boxes`, -1: none there
  };

  NestedOctrees() = default;
  // For capacities of at least `smallest` and first levels up to the one given, or above all leaves.
  NestedOctrees(std::vector<std::uint64_t> const& source_keys, std::vector<std::uint64_t> const& target_keys, OctreeOptions const& smallest);

  std::vector<Level> const& levels() const { return levels_; }
  static bool is_refined(Level const& in, int level, std::size_t box, OctreeChoice const& octree) {
    return level < octree.first_level || in.refined_below[box] > 2 * octree.capacity;
  }
  static bool exists(Level const& in, int level, std::size_t box, OctreeChoice const& octree) {
    return level <= octree.first_level || in.exist_below[box] > 2 * octree.capacity;
  }
  std::vector<Box const*> refined(int level, OctreeChoice const& octree) const;
  int n_refined_level() const { return static_cast<int>(levels_.size()) - 1; }  // of the smallest leaves
  int level_of_largest_leaf(long capacity) const;  // of that octree whose first level is the root's

 private:
  std::vector<Level> levels_;
};

}  // namespace asterflow

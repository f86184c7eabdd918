#include "backends/fast_nested.hpp"

#include <algorithm>
#include <limits>

namespace asterflow {
namespace {

constexpr long always = std::numeric_limits<long>::max();

using Level = NestedOctrees::Level;

// Refined boxes and leaves of one level; capacities but for the balance.
Level merged(OctreeBoxes const& tree, std::size_t level) {
  static std::vector<Box> const none;
  auto const& refined = level < tree.refined().size() ? tree.refined()[level].boxes() : none;
  auto const& leaves = tree.leaves()[level].boxes();
  std::size_t const n = refined.size() + leaves.size();
  Level all;
  all.boxes.reserve(n), all.refined_below.reserve(n), all.exist_below.reserve(n);
  for (std::size_t r = 0, l = 0; r + l < n;) {
    bool const is_refined = l == leaves.size() || (r < refined.size() && refined[r].key < leaves[l].key);
    Box const& box = is_refined ? refined[r++] : leaves[l++];
    all.boxes.push_back(box);
    all.refined_below.push_back(is_refined ? box.sources.size() + box.targets.size() : 0);
  }
  return all;
}

// Where the 27 boxes around a box in each octant of its parent are: in which box around the parent, in which octant of it.
struct Place {
  int box, octant;
};
constexpr auto places_around = [] {
  std::array<std::array<Place, 27>, 8> places{};
  for (int octant = 0; octant < 8; ++octant)
    for (int i = 0; i < 27; ++i) {
      int const step[3] = {i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
      Place& place = places[octant][i];
      for (int d = 2; d >= 0; --d) {
        int const x = (octant >> d & 1) + step[d];  // from the parent's corner
        place.box = 3 * place.box + (x < 0 ? 0 : x < 2 ? 1 : 2);
        place.octant = 2 * place.octant + (x & 1);
      }
    }
  return places;
}();

std::vector<std::int32_t> parents_of(Level const& level, Level const& above) {
  std::vector<std::int32_t> parents;
  parents.reserve(level.boxes.size());
  std::int32_t parent = 0;
  for (Box const& box : level.boxes) {
    while (above.boxes[parent].key != box.key >> 3) ++parent;
    parents.push_back(parent);
  }
  return parents;
}

// Neighbours are children of the parent's neighbours.
void find_around(Level const& above, std::vector<std::int32_t> const& parents, Level& level) {
  std::array<std::int32_t, 8> none;
  none.fill(-1);
  std::vector<std::array<std::int32_t, 8>> children(above.boxes.size(), none);
  for (std::size_t i = 0; i < parents.size(); ++i) children[parents[i]][level.boxes[i].key & 7] = static_cast<std::int32_t>(i);
  level.around.resize(level.boxes.size());
  for (std::size_t i = 0; i < parents.size(); ++i) {
    auto const& places = places_around[level.boxes[i].key & 7];
    auto const& around_parent = above.around[parents[i]];
    for (int k = 0; k < 27; ++k) {
      std::int32_t const box = around_parent[places[k].box];
      level.around[i][k] = box < 0 ? -1 : children[box][places[k].octant];
    }
  }
}

// A refined box wants the parents of its neighbours to be refined.
void balance(Level const& level, std::vector<std::int32_t> const& parents, Level& above) {
  for (std::size_t i = 0; i < level.boxes.size(); ++i) {
    if (level.refined_below[i] == 0) continue;
    for (int corner : {0, 2, 6, 8, 18, 20, 24, 26}) {
      std::int32_t const parent = above.around[parents[i]][places_around[level.boxes[i].key & 7][corner].box];
      if (parent >= 0) above.refined_below[parent] = std::max(above.refined_below[parent], level.refined_below[i]);
    }
  }
}

}  // namespace

NestedOctrees::NestedOctrees(std::vector<std::uint64_t> const& source_keys, std::vector<std::uint64_t> const& target_keys,
                             OctreeOptions const& smallest) {
  OctreeBoxes const tree(source_keys, target_keys, smallest);
  std::vector<std::vector<std::int32_t>> parents(tree.leaves().size());
  for (std::size_t l = 0; l < tree.leaves().size(); ++l) {
    levels_.push_back(merged(tree, l));
    Level& level = levels_.back();
    if (l > 0) {
      parents[l] = parents_of(level, levels_[l - 1]);
      find_around(levels_[l - 1], parents[l], level);
    } else {
      level.around.resize(1);
      level.around[0].fill(-1);
      level.around[0][13] = 0;
    }
  }
  for (std::size_t l = levels_.size(); l-- > 1;) balance(levels_[l], parents[l], levels_[l - 1]);
  levels_[0].exist_below = {always};
  for (std::size_t l = 1; l < levels_.size(); ++l)
    for (std::int32_t parent : parents[l]) levels_[l].exist_below.push_back(levels_[l - 1].refined_below[parent]);
}

std::vector<Box const*> NestedOctrees::refined(int level, OctreeChoice const& octree) const {
  std::vector<Box const*> found;
  Level const& in = levels_[level];
  for (std::size_t i = 0; i < in.boxes.size(); ++i)
    if (is_refined(in, level, i, octree)) found.push_back(&in.boxes[i]);
  return found;
}

int NestedOctrees::level_of_largest_leaf(long capacity) const {
  for (int l = 0; l < static_cast<int>(levels_.size()); ++l)
    for (std::size_t i = 0; i < levels_[l].boxes.size(); ++i)
      if (levels_[l].exist_below[i] > 2 * capacity && levels_[l].refined_below[i] <= 2 * capacity) return l;
  return static_cast<int>(levels_.size());
}

}  // namespace asterflow

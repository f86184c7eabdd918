#include "backends/fast_boxes.hpp"

#include <algorithm>
#include <bit>

namespace asterflow {
namespace {

using Keys = std::vector<std::uint64_t>;

bool by_key(Box const& a, Box const& b) { return a.key < b.key; }

// Makes boxes from the sorted keys of their points.
class BoxMaker {
 public:
  BoxMaker(Keys const& sources, Keys const& targets) : sources_(sources), targets_(targets) {}

  Box root() const { return {0, {0, 0, 0}, {0, static_cast<long>(sources_.size())}, {0, static_cast<long>(targets_.size())}}; }

  // Adds the children, of `level`, that have points.
  void add_children(Box const& parent, int level, std::vector<Box>& children) const {
    Range source{parent.sources.begin, parent.sources.begin}, target{parent.targets.begin, parent.targets.begin};
    for (std::uint64_t i = 0; i < 8; ++i) {
      std::uint64_t const key = parent.key * 8 + i;
      source = {source.end, end_of(sources_, source.end, parent.sources.end, level, key)};
      target = is_same() ? source : Range{target.end, end_of(targets_, target.end, parent.targets.end, level, key)};
      if (source.size() + target.size() == 0) continue;
      Box child{key, {2 * parent.place[0], 2 * parent.place[1], 2 * parent.place[2]}, source, target};
      for (int d = 0; d < 3; ++d) child.place[d] += static_cast<int>(i >> d & 1);
      children.push_back(child);
    }
  }

  Box any(int level, std::uint64_t key) const {
    auto const range = [&](Keys const& keys) {
      long const n = static_cast<long>(keys.size()), end = end_of(keys, 0, n, level, key);
      return Range{key == 0 ? 0 : end_of(keys, 0, end, level, key - 1), end};
    };
    Range const sources = range(sources_);
    return box(key, sources, is_same() ? sources : range(targets_));
  }

  // All points in one cell of the finest level: nothing to gain from refining.
  bool is_one_place(Box const& b) const {
    std::uint64_t low = ~std::uint64_t{0}, high = 0;
    auto const include = [&](Keys const& keys, Range const& range) {
      if (range.size() == 0) return;
      low = std::min(low, keys[range.begin]);
      high = std::max(high, keys[range.end - 1]);
    };
    include(sources_, b.sources);
    include(targets_, b.targets);
    return low == high;
  }

 private:
  static constexpr long few = 64;  // searched one by one

  bool is_same() const { return &sources_ == &targets_; }

  // The first place in begin ... end whose key is beyond the box `key` of `level`.
  static long end_of(Keys const& keys, long begin, long end, int level, std::uint64_t key) {
    std::uint64_t const beyond = (key + 1) << 3 * (morton_levels - level);
    if (end - begin > few) return std::lower_bound(keys.begin() + begin, keys.begin() + end, beyond) - keys.begin();
    while (begin < end && keys[begin] < beyond) ++begin;
    return begin;
  }
  static Box box(std::uint64_t key, Range const& sources, Range const& targets) {
    return {key, {morton_coordinate(key, 0), morton_coordinate(key, 1), morton_coordinate(key, 2)}, sources, targets};
  }

  Keys const& sources_;
  Keys const& targets_;
};

std::vector<std::vector<Box>> refine(BoxMaker const& make, OctreeOptions const& options) {
  std::vector<std::vector<Box>> levels;
  std::vector<Box> boxes{make.root()};
  for (int level = 0; level < OctreeBoxes::max_level && !boxes.empty(); ++level) {
    std::vector<Box> refined, children;
    for (Box const& box : boxes) {
      bool const is_leaf = box.sources.size() + box.targets.size() <= 2 * options.capacity || make.is_one_place(box);
      if (level >= options.first_level && is_leaf) continue;
      refined.push_back(box);
      make.add_children(box, level + 1, children);
    }
    if (!refined.empty()) levels.push_back(std::move(refined));
    boxes = std::move(children);
  }
  return levels;
}

// Parents of the neighbours of these boxes, of `level`, that are not among `above`.
Keys missing_parents(BoxLevel const& boxes, int level, BoxLevel const& above) {
  Keys missing;
  for (Box const& box : boxes.boxes()) {
    std::uint64_t const own = box.key >> 3;
    auto const around = neighbour_keys(own, level - 1);
    int step[3];  // to the other parent of the neighbours along a direction, among those around the own
    for (int d = 0; d < 3; ++d) step[d] = static_cast<int>(2 * (box.key >> d & 1)) - 1;
    for (int i = 1; i < 8; ++i) {
      std::uint64_t const key = around[13 + step[0] * (i & 1) + 3 * step[1] * (i >> 1 & 1) + 9 * step[2] * (i >> 2)];
      if (key != no_key && !above.find(key)) missing.push_back(key);
    }
  }
  std::sort(missing.begin(), missing.end());
  missing.erase(std::unique(missing.begin(), missing.end()), missing.end());
  return missing;
}

}  // namespace

std::array<std::uint64_t, 27> neighbour_keys(std::uint64_t key, int level) {
  std::uint64_t along[3][3];  // the bits of x - 1, x, x + 1 of each direction
  for (int d = 0; d < 3; ++d) {
    std::uint64_t const all = (0x1249249249249249u & ((std::uint64_t{1} << 3 * level) - 1)) << d, x = key & all;
    along[d][0] = x == 0 ? no_key : (x - 1) & all;
    along[d][1] = x;
    along[d][2] = x == all ? no_key : ((x | ~all) + 1) & all;
  }
  std::array<std::uint64_t, 27> keys;
  for (int i = 0; i < 27; ++i) {
    std::uint64_t const x = along[0][i % 3], y = along[1][i / 3 % 3], z = along[2][i / 9];
    keys[i] = x == no_key || y == no_key || z == no_key ? no_key : x | y | z;
  }
  return keys;
}

BoxLevel::BoxLevel(std::vector<Box> boxes) : boxes_(std::move(boxes)) {
  if (!std::is_sorted(boxes_.begin(), boxes_.end(), by_key)) std::sort(boxes_.begin(), boxes_.end(), by_key);
  slots_.assign(2 * std::bit_ceil(boxes_.size() + 1), {no_key, 0});
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    std::size_t at = first_slot(boxes_[i].key);
    while (slots_[at].key != no_key) at = (at + 1) & (slots_.size() - 1);
    slots_[at] = {boxes_[i].key, static_cast<std::uint32_t>(i)};
  }
}

std::size_t BoxLevel::first_slot(std::uint64_t key) const {
  return (key * 0x9e3779b97f4a7c15u) >> (64 - std::countr_zero(slots_.size()));
}

Box const* BoxLevel::find(std::uint64_t key) const {
  if (boxes_.empty()) return nullptr;
  for (std::size_t at = first_slot(key); slots_[at].key != no_key; at = (at + 1) & (slots_.size() - 1))
    if (slots_[at].key == key) return &boxes_[slots_[at].index];
  return nullptr;
}

OctreeBoxes::OctreeBoxes(Keys const& source_keys, Keys const& target_keys, OctreeOptions const& options) {
  BoxMaker const make(source_keys, target_keys);
  auto levels = refine(make, options);
  refined_.resize(levels.size());
  // A refined box needs its neighbours of the same size to exist, hence their parents to be refined.
  for (int level = static_cast<int>(levels.size()) - 1; level >= 0; --level) {
    refined_[level] = BoxLevel(std::move(levels[level]));
    if (level + 1 == static_cast<int>(levels.size())) continue;
    std::vector<Box> more;
    for (std::uint64_t key : missing_parents(refined_[level + 1], level + 1, refined_[level])) {
      Box const box = make.any(level, key);
      if (box.sources.size() + box.targets.size() > 0) more.push_back(box);
    }
    if (more.empty()) continue;
    more.insert(more.end(), refined_[level].boxes().begin(), refined_[level].boxes().end());
    refined_[level] = BoxLevel(std::move(more));
  }
  leaves_.resize(refined_.size() + 1);
  if (refined_.empty()) leaves_[0] = BoxLevel({make.root()});
  for (std::size_t level = 0; level < refined_.size(); ++level) {
    std::vector<Box> children;
    for (Box const& box : refined_[level].boxes()) make.add_children(box, static_cast<int>(level) + 1, children);
    if (level + 1 < refined_.size())
      std::erase_if(children, [&](Box const& child) { return refined_[level + 1].find(child.key) != nullptr; });
    leaves_[level + 1] = BoxLevel(std::move(children));
  }
}

std::size_t OctreeBoxes::memory() const {
  std::size_t bytes = 0;
  for (auto const* levels : {&refined_, &leaves_})
    for (BoxLevel const& level : *levels) bytes += level.memory();
  return bytes;
}

}  // namespace asterflow

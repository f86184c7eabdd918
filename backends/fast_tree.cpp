#include "backends/fast_tree.hpp"

#include "base/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace asterflow {
namespace {

constexpr int key_levels = Octree::max_level + 1;  // 3 * 21 bits

std::uint64_t spread_bits(std::uint64_t x) {
  x &= 0x1fffff;
  x = (x | x << 32) & 0x1f00000000ffff;
  x = (x | x << 16) & 0x1f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  return (x | x << 2) & 0x1249249249249249;
}

int gather_bits(std::uint64_t x) {
  x &= 0x1249249249249249;
  x = (x | x >> 2) & 0x10c30c30c30c30c3;
  x = (x | x >> 4) & 0x100f00f00f00f00f;
  x = (x | x >> 8) & 0x1f0000ff0000ff;
  x = (x | x >> 16) & 0x1f00000000ffff;
  return static_cast<int>((x | x >> 32) & 0x1fffff);
}

std::uint64_t morton(std::uint64_t x, std::uint64_t y, std::uint64_t z) {
  return spread_bits(x) | spread_bits(y) << 1 | spread_bits(z) << 2;
}

Range range_of(std::vector<std::uint64_t> const& keys, int level, std::uint64_t key) {
  int const shift = 3 * (key_levels - level);
  auto const first = std::lower_bound(keys.begin(), keys.end(), key << shift);
  auto const last = std::lower_bound(first, keys.end(), (key + 1) << shift);
  return {first - keys.begin(), last - keys.begin()};
}

bool by_key(Box const& a, Box const& b) { return a.key < b.key; }

// Stable radix sort of (key, index) pairs, 11 bits at a time.
struct KeyedIndex {
  std::uint64_t key;
  std::uint32_t index;
};

void sort_keys(std::vector<KeyedIndex>& items) {
  std::vector<KeyedIndex> other(items.size());
  for (int shift = 0; shift < 3 * key_levels; shift += 11) {
    std::vector<std::size_t> start(2049, 0);
    for (auto const& item : items) ++start[((item.key >> shift) & 2047) + 1];
    if (*std::max_element(start.begin(), start.end()) == items.size()) continue;
    for (int i = 0; i < 2048; ++i) start[i + 1] += start[i];
    for (auto const& item : items) other[start[(item.key >> shift) & 2047]++] = item;
    items.swap(other);
  }
}

}  // namespace

Octree::Octree(ConstPoints sources, ConstPoints targets, OctreeOptions const& options) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  Vec3d low{infinite, infinite, infinite}, high{-infinite, -infinite, -infinite};
  for (ConstPoints points : {sources, targets})
    for (Vec3d const& p : points)
      for (int d = 0; d < 3; ++d) {
        low[d] = std::min(low[d], p[d]);
        high[d] = std::max(high[d], p[d]);
      }
  extent_ = high - low;
  double const widest = std::max({extent_.x, extent_.y, extent_.z});
  side_ = widest > 0.0 ? widest * options.enlargement * (1.0 + 1e-9) : 1.0;
  extent_ = extent_ / side_;
  int exponent = 0;
  unit_side_ = std::frexp(side_, &exponent);
  double const unit = std::ldexp(1.0, exponent);
  for (int d = 0; d < 3; ++d) origin_[d] = std::abs(low[d]) < 4.0 * unit ? 0.0 : std::floor(low[d] / unit) * unit;
  corner_ = (low - origin_) * (1.0 / unit);
  first_level_ = options.first_level;
  bool const same = sources.data() == targets.data() && sources.size() == targets.size();
  sort_points(sources, source_keys_, source_order_, sources_);
  if (same) {
    target_keys_ = source_keys_;
    target_order_ = source_order_;
    targets_ = sources_;
  } else {
    sort_points(targets, target_keys_, target_order_, targets_);
  }
  refine(options);
  balance();
  collect_leaves();
  source_keys_ = {};
  target_keys_ = {};
}

void Octree::sort_points(ConstPoints points, std::vector<std::uint64_t>& keys, std::vector<std::uint32_t>& order,
                         PointArray& sorted) const {
  long const n = static_cast<long>(points.size());
  double const cells = static_cast<double>(1 << key_levels);
  std::vector<KeyedIndex> items(n);
  double const by_unit = unit_side_ / side_;  // a power of two
  auto const placed = [&](long i) { return (points[i] - origin_) * by_unit; };
  constexpr long block = 4096;
  parallel_for("Octree::sort_points", (n + block - 1) / block, [&](long i_block) {
    for (long i = i_block * block; i < std::min(n, (i_block + 1) * block); ++i) {
      Vec3d const p = normalised(placed(i));
      auto const cell = [&](double x) {
        return static_cast<std::uint64_t>(std::clamp(x * cells, 0.0, cells - 1.0));
      };
      items[i] = {morton(cell(p.x), cell(p.y), cell(p.z)), static_cast<std::uint32_t>(i)};
    }
  });
  sort_keys(items);
  keys.resize(n);
  order.resize(n);
  sorted.resize(n);
  parallel_for("Octree::sort_points::gather", (n + block - 1) / block, [&](long i_block) {
    for (long i = i_block * block; i < std::min(n, (i_block + 1) * block); ++i) {
      keys[i] = items[i].key;
      order[i] = items[i].index;
      sorted[i] = placed(items[i].index);
    }
  });
}

Box Octree::make_box(int level, std::uint64_t key) const {
  Box box;
  box.key = key;
  box.place[0] = gather_bits(key);
  box.place[1] = gather_bits(key >> 1);
  box.place[2] = gather_bits(key >> 2);
  box.sources = range_of(source_keys_, level, key);
  box.targets = range_of(target_keys_, level, key);
  return box;
}

// All points in one cell of the finest level: nothing to gain from refining.
bool Octree::is_one_place(Box const& box) const {
  std::uint64_t low = ~std::uint64_t{0}, high = 0;
  if (box.sources.size() > 0) {
    low = source_keys_[box.sources.begin];
    high = source_keys_[box.sources.end - 1];
  }
  if (box.targets.size() > 0) {
    low = std::min(low, target_keys_[box.targets.begin]);
    high = std::max(high, target_keys_[box.targets.end - 1]);
  }
  return low == high;
}

void Octree::refine(OctreeOptions const& options) {
  std::vector<Box> boxes{make_box(0, 0)};
  for (int level = 0; level < max_level && !boxes.empty(); ++level) {
    std::vector<Box> refined, children;
    for (Box const& box : boxes) {
      if (level >= options.first_level && box.sources.size() + box.targets.size() <= 2 * options.capacity) continue;
      if (is_one_place(box)) continue;
      refined.push_back(box);
      for (std::uint64_t i = 0; i < 8; ++i) {
        Box const child = make_box(level + 1, box.key * 8 + i);
        if (child.sources.size() + child.targets.size() > 0) children.push_back(child);
      }
    }
    if (!refined.empty()) refined_.push_back(std::move(refined));
    boxes = std::move(children);
  }
}

// A refined box needs its neighbours of the same size to exist, hence their parents to be refined.
void Octree::balance() {
  for (int level = static_cast<int>(refined_.size()) - 1; level > 1; --level) {
    std::vector<std::uint64_t> parents;
    int const width = 1 << level;
    for (Box const& box : refined_[level])
      for (int i = 0; i < 27; ++i) {
        int const x = box.place[0] + i % 3 - 1, y = box.place[1] + i / 3 % 3 - 1, z = box.place[2] + i / 9 - 1;
        if (x < 0 || y < 0 || z < 0 || x >= width || y >= width || z >= width) continue;
        parents.push_back(morton(x, y, z) >> 3);
      }
    std::sort(parents.begin(), parents.end());
    parents.erase(std::unique(parents.begin(), parents.end()), parents.end());
    std::vector<Box>& above = refined_[level - 1];
    std::size_t const n_before = above.size();
    for (std::uint64_t key : parents) {
      Box wanted;
      wanted.key = key;
      if (std::binary_search(above.begin(), above.begin() + n_before, wanted, by_key)) continue;
      Box const box = make_box(level - 1, key);
      if (box.sources.size() + box.targets.size() > 0) above.push_back(box);
    }
    std::sort(above.begin(), above.end(), by_key);
  }
}

void Octree::collect_leaves() {
  leaves_.resize(refined_.size() + 1);
  if (refined_.empty()) leaves_[0].push_back(make_box(0, 0));
  for (std::size_t level = 0; level < refined_.size(); ++level)
    for (Box const& box : refined_[level])
      for (std::uint64_t i = 0; i < 8; ++i) {
        Box const child = make_box(static_cast<int>(level) + 1, box.key * 8 + i);
        if (child.sources.size() + child.targets.size() == 0) continue;
        if (level + 1 < refined_.size() &&
            std::binary_search(refined_[level + 1].begin(), refined_[level + 1].end(), child, by_key))
          continue;
        leaves_[level + 1].push_back(child);
      }
}

Box const* Octree::find(std::vector<Box> const& boxes, int x, int y, int z) {
  Box wanted;
  wanted.key = morton(x, y, z);
  auto const found = std::lower_bound(boxes.begin(), boxes.end(), wanted, by_key);
  return found != boxes.end() && found->key == wanted.key ? &*found : nullptr;
}

std::size_t Octree::memory() const {
  std::size_t bytes = sizeof(Vec3d) * (sources_.capacity() + targets_.capacity()) +
                      sizeof(std::uint32_t) * (source_order_.capacity() + target_order_.capacity());
  for (auto const* levels : {&refined_, &leaves_})
    for (auto const& boxes : *levels) bytes += sizeof(Box) * boxes.capacity();
  return bytes;
}

void Octree::reorder_targets(Range leaf, std::vector<std::uint32_t> const& order) {
  PointArray points(leaf.size());
  std::vector<std::uint32_t> originals(leaf.size());
  for (long i = 0; i < leaf.size(); ++i) {
    points[i] = targets_[order[i]];
    originals[i] = target_order_[order[i]];
  }
  std::copy(points.begin(), points.end(), targets_.begin() + leaf.begin);
  std::copy(originals.begin(), originals.end(), target_order_.begin() + leaf.begin);
}

}  // namespace asterflow

#pragma once
// The boxes of an adaptive octree over points sorted along the Morton curve. A box with more points than the capacity is
// refined; boxes that touch a refined box of their own size exist (2:1 balance).

#include "backends/fast_order.hpp"

#include <array>

namespace asterflow {

struct Range {
  long begin = 0, end = 0;
  long size() const { return end - begin; }
};

struct Box {
  std::uint64_t key = 0;         // Morton index within its level
  int place[3] = {0, 0, 0};      // integer coordinates within its level
  Range sources, targets;        // in sorted order
};

struct OctreeOptions {
  long capacity = 100;      // points of a leaf, mean of sources and targets
  int first_level = 0;      // all boxes above it are refined
  double enlargement = 1.0; // side of the unit cube over the largest extent of the points
};

// Keys of a box and the 26 around it; no_key where there is no such place.
inline constexpr std::uint64_t no_key = ~std::uint64_t{0};
std::array<std::uint64_t, 27> neighbour_keys(std::uint64_t key, int level);

// The boxes of one kind and level, sorted by key, and where each of them is.
class BoxLevel {
 public:
  BoxLevel() = default;
  explicit BoxLevel(std::vector<Box> boxes);  // takes them in any order

  std::vector<Box> const& boxes() const { return boxes_; }
  Box const* find(std::uint64_t key) const;
  std::size_t memory() const { return sizeof(Box) * boxes_.capacity() + sizeof(KeyedIndex) * slots_.capacity(); }

 private:
  std::size_t first_slot(std::uint64_t key) const;

  std::vector<Box> boxes_;
  std::vector<KeyedIndex> slots_;  // open addressing; no_key where there is no box
};

class OctreeBoxes {
 public:
  static constexpr int max_level = morton_levels - 1;

  OctreeBoxes() = default;
  // Keys of sources and targets, ascending; the same array where they are the same points.
  OctreeBoxes(std::vector<std::uint64_t> const& source_keys, std::vector<std::uint64_t> const& target_keys,
              OctreeOptions const& options);

  // By level; there is one level of leaves more.
  std::vector<BoxLevel> const& refined() const { return refined_; }
  std::vector<BoxLevel> const& leaves() const { return leaves_; }

  // The box of that key, if it is one of these.
  Box const* leaf(int level, std::uint64_t key) const { return leaves_[level].find(key); }
  Box const* refined_box(int level, std::uint64_t key) const {
    return level < static_cast<int>(refined_.size()) ? refined_[level].find(key) : nullptr;
  }

  std::size_t memory() const;

 private:
  std::vector<BoxLevel> refined_, leaves_;
};

}  // namespace asterflow

#pragma once
// Adaptive octree over sources and targets. Points are sorted along the Morton curve, so every box owns one range of
// sources and one of targets. A box with more points than the capacity is refined; boxes that touch a refined box of
// their own size exist (2:1 balance). Coordinates are those given up to a power of two, moved only where the points are
// far from the origin and then by a number with few bits: differences are those of the given points, bit by bit.

#include "base/arrays.hpp"

#include <cstdint>
#include <vector>

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

class Octree {
 public:
  static constexpr int max_level = 20;

  // All coordinates finite, at least one source and one target.
  Octree(ConstPoints sources, ConstPoints targets, OctreeOptions const& options);

  double side() const { return side_; }                   // of the root, in the units of the points given
  PointArray const& sources() const { return sources_; }  // sorted
  PointArray const& targets() const { return targets_; }
  Vec3d corner() const { return corner_; }                // of the root, in the units of these
  double unit_side() const { return unit_side_; }         // likewise its side, 0.5 ... 1
  Vec3d normalised(Vec3d x) const { return (x - corner_) / unit_side_; }  // to the unit cube
  std::vector<std::uint32_t> const& source_order() const { return source_order_; }  // original index of each
  std::vector<std::uint32_t> const& target_order() const { return target_order_; }
  int first_level() const { return first_level_; }
  Vec3d extent() const { return extent_; }              // of all points, normalised
  std::size_t memory() const;

  // By level, sorted by key.
  std::vector<std::vector<Box>> const& refined() const { return refined_; }
  std::vector<std::vector<Box>> const& leaves() const { return leaves_; }

  static Box const* find(std::vector<Box> const& boxes, int x, int y, int z);

  // Exchanges the order of the targets of one leaf; `order` lists their present positions.
  void reorder_targets(Range leaf, std::vector<std::uint32_t> const& order);

 private:
  void sort_points(ConstPoints points, std::vector<std::uint64_t>& keys, std::vector<std::uint32_t>& order,
                   PointArray& sorted) const;
  Box make_box(int level, std::uint64_t key) const;
  bool is_one_place(Box const& box) const;
  void refine(OctreeOptions const& options);
  void balance();
  void collect_leaves();

  Vec3d origin_, corner_, extent_;
  double side_ = 1.0, unit_side_ = 1.0;
  int first_level_ = 0;
  PointArray sources_, targets_;
  std::vector<std::uint32_t> source_order_, target_order_;
  std::vector<std::uint64_t> source_keys_, target_keys_;
  std::vector<std::vector<Box>> refined_, leaves_;
};

}  // namespace asterflow

#pragma once
// Points in the order of the Morton curve through a cube around them, so that every box of an octree of that cube owns
// one range of them. Coordinates are those given up to a power of two, moved only where the points are
// far from the origin and then by a number with few bits: differences are those of the given points, bit by bit.

#include "base/arrays.hpp"

#include <cstdint>
#include <vector>

namespace asterflow {

inline constexpr int morton_levels = 21;  // of a key, three bits each

// Whether they are the same points in one order.
bool is_same(ConstPoints a, ConstPoints b);

// Cell (x, y, z) of a level's 2^level cells per direction.
std::uint64_t morton_key(std::uint64_t x, std::uint64_t y, std::uint64_t z);
int morton_coordinate(std::uint64_t key, int direction);

// The cube: its lowest corner is that of the points' bounding box, its side `enlargement` times the longest extent.
struct RootCube {
  double side = 1.0;               // in the units of the points given
  double unit_side = 1.0;          // 0.5 ... 1, likewise once placed
  Vec3d origin, corner;            // what placing takes away; lowest corner once placed
  Vec3d extent;                    // of all points, over the side
  double largest_distance = 0.0;   // no two points are farther apart, likewise

  // All coordinates finite, at least one point.
  RootCube(ConstPoints sources, ConstPoints targets, double enlargement);

  Vec3d placed(Vec3d x) const { return (x - origin) * (unit_side / side); }  // the factor is a power of two
  Vec3d normalised(Vec3d placed) const { return (placed - corner) / unit_side; }
};

struct OrderedPoints {
  std::vector<std::uint64_t> keys;   // of the finest level, ascending
  std::vector<std::uint32_t> order;  // index among the points given; ascends where keys are equal
  PointArray points;                 // placed
};

OrderedPoints order_points(ConstPoints points, RootCube const& cube);

struct KeyedIndex {
  std::uint64_t key;    // of the cell of the finest level that a point is in
  std::uint32_t index;  // of the point
};

// items [n_point], overwritten from begin to end - 1, on this thread.
void find_keys(ConstPoints points, long begin, long end, RootCube const& cube, KeyedIndex* items);
// Of all points, sorted.
std::vector<KeyedIndex> sorted_keys(ConstPoints points, RootCube const& cube);

}  // namespace asterflow

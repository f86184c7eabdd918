#include "backends/fast_nested.hpp"

#include "base/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace asterflow {
namespace {

// Keys of points some of which crowd around one place.
std::vector<std::uint64_t> keys_of_points(long n, std::uint64_t seed) {
  std::vector<std::uint64_t> keys;
  for (long i = 0; i < n; ++i) {
    std::uint64_t place[3];
    for (int d = 0; d < 3; ++d) {
      double const x = uniform_random(seed, i, d, 0);
      place[d] = static_cast<std::uint64_t>((1 << morton_levels) * (i % 3 == 0 ? 0.3 + 0.01 * x * x : x));
    }
    keys.push_back(morton_key(place[0], place[1], place[2]));
  }
  std::sort(keys.begin(), keys.end());
  return keys;
}

std::vector<std::uint64_t> keys_of(std::vector<Box> const& boxes) {
  std::vector<std::uint64_t> keys;
  for (Box const& box : boxes) keys.push_back(box.key);
  return keys;
}

TEST(Nested_octrees, have_the_boxes_of_the_octree_of_every_capacity_and_first_level) {
  auto const sources = keys_of_points(900, 1), targets = keys_of_points(500, 2);
  constexpr int deepest_first = 3;
  for (auto const* target_keys : {&sources, &targets})
    for (int built_first : {0, deepest_first}) {
      NestedOctrees const nested(sources, *target_keys, {.capacity = 5, .first_level = built_first});
      for (long capacity : {5L, 6L, 9L, 20L, 100L, 2000L})
        for (int first_level = 0; first_level <= built_first; ++first_level) {
          OctreeBoxes const octree(sources, *target_keys, {.capacity = capacity, .first_level = first_level});
          OctreeChoice const choice{capacity, first_level};
          for (int l = 0; l < static_cast<int>(nested.levels().size()); ++l) {
            std::vector<std::uint64_t> refined, leaves;
            auto const& level = nested.levels()[l];
            for (std::size_t i = 0; i < level.boxes.size(); ++i) {
              if (!NestedOctrees::exists(level, l, i, choice)) continue;
              (NestedOctrees::is_refined(level, l, i, choice) ? refined : leaves).push_back(level.boxes[i].key);
            }
            auto const at = static_cast<std::size_t>(l);
            EXPECT_EQ(refined, at < octree.refined().size() ? keys_of(octree.refined()[at].boxes()) : std::vector<std::uint64_t>{});
            EXPECT_EQ(leaves, at < octree.leaves().size() ? keys_of(octree.leaves()[at].boxes()) : std::vector<std::uint64_t>{});
          }
        }
    }
}

TEST(Nested_octrees, know_the_boxes_around_each_box) {
  auto const keys = keys_of_points(900, 3);
  NestedOctrees const nested(keys, keys, {.capacity = 5, .first_level = 0});
  for (int l = 0; l < static_cast<int>(nested.levels().size()); ++l) {
    auto const& level = nested.levels()[l];
    for (std::size_t i = 0; i < level.boxes.size(); ++i) {
      auto const around = neighbour_keys(level.boxes[i].key, l);
      for (int k = 0; k < 27; ++k) {
        auto const has_key = [&](Box const& box) { return box.key == around[k]; };
        auto const found = std::ranges::find_if(level.boxes, has_key);
        EXPECT_EQ(level.around[i][k], found == level.boxes.end() ? -1 : found - level.boxes.begin());
      }
    }
  }
}

TEST(Octree_boxes, neighbours_lie_within_the_root) {
  for (int level : {0, 1, 2, morton_levels}) {
    std::uint64_t const last = (std::uint64_t{1} << level) - 1;
    for (std::uint64_t x : {std::uint64_t{0}, last / 2, last}) {
      auto const keys = neighbour_keys(morton_key(x, last, 0), level);
      for (int i = 0; i < 27; ++i) {
        long const place[3] = {static_cast<long>(x) + i % 3 - 1, static_cast<long>(last) + i / 3 % 3 - 1, i / 9 - 1L};
        bool const is_inside = std::ranges::all_of(place, [&](long p) { return p >= 0 && p <= static_cast<long>(last); });
        EXPECT_EQ(keys[i], is_inside ? morton_key(place[0], place[1], place[2]) : no_key);
      }
    }
  }
}

}  // namespace
}  // namespace asterflow

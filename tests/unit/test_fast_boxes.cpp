#include "backends/fast_boxes.hpp"

#include <gtest/gtest.h>

namespace asterflow {

TEST(Octree_boxes, have_no_leaf_above_the_first_level_even_for_one_point_far_from_the_others) {
  std::uint64_t const far = (std::uint64_t{1} << 3 * morton_levels) - 1;
  std::vector<std::uint64_t> const keys{0, 1, 2, 3, 4, far};
  for (int first_level : {0, 1, 4}) {
    OctreeBoxes const boxes(keys, keys, {.capacity = 2, .first_level = first_level});
    for (int level = 0; level < first_level; ++level) EXPECT_TRUE(boxes.leaves()[level].boxes().empty()) << level;
    long n = 0;
    for (auto const& level : boxes.leaves())
      for (Box const& box : level.boxes()) n += box.sources.size();
    EXPECT_EQ(n, 6);
  }
}

}  // namespace asterflow

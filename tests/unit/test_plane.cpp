#include "base/error.hpp"
#include "io/plane.hpp"

#include <gtest/gtest.h>

using namespace asterflow;

TEST(Plane, Reads_the_words_of_the_command_line) {
  EXPECT_EQ(parse_plane("z=0").normal, 2);
  EXPECT_EQ(parse_plane("x = -2.5").offset, -2.5);
  int n_first = 0, n_second = 0;
  parse_grid("240x150", n_first, n_second);
  EXPECT_EQ(n_first, 240);
  EXPECT_EQ(n_second, 150);
}

TEST(Plane, Refuses_what_is_not_a_plane_or_grid) {
  int n = 0, m = 0;
  for (char const* text : {"z", "w=0", "z=", "z=a", "z=0 1", "z=nan"}) EXPECT_THROW(parse_plane(text), SceneError) << text;
  for (char const* text : {"240", "240x", "1x10", "-3x5", "10x10x10", "axb"})
    EXPECT_THROW(parse_grid(text, n, m), SceneError) << text;
}

TEST(Plane, Points_fill_the_rectangle_row_by_row) {
  PlanePoints const grid{parse_plane("y=3"), 3, 2, {-1, 0}, {1, 5}};
  PointArray const points = grid.points();
  ASSERT_EQ(points.size(), 6u);
  EXPECT_EQ(points[2].x, 1.0);
  EXPECT_EQ(points[2].y, 3.0);
  EXPECT_EQ(points[2].z, 0.0);
  EXPECT_EQ(points[3].z, 5.0);
}

#include "io/paraview.hpp"

#include <gtest/gtest.h>
#include <numbers>

using namespace asterflow;

namespace {

Scene scene_with_a_ball() {
  return parse_scene("[[body]]\nshape = 'sphere'\nradius = 2\nposition = [1, 0, 0]\n", "scene.toml");
}

Frame frame_with_two_fibers() {
  PointArray const nodes{{1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {0, 2, 0}, {0, 3, 0}};
  return {1.5,
          {NamedArray::of("body/position", PointArray{{1, 0, 0}}, "um"),
           NamedArray{"body/orientation", {1, 4}, std::vector<double>{1, 0, 0, 0}, ""},
           NamedArray::of("fiber/first", std::vector<std::int64_t>{0, 2, 5}), NamedArray::of("fiber/position", nodes, "um"),
           NamedArray::of("fiber/minus_end", PointArray{{0, 0, 0}, {0, 0, 0}}, "um"),
           NamedArray::of("fiber/plus_end", PointArray{{3, 0, 0}, {0, 4, 0}}, "um"),
           NamedArray::of("fiber/tension", std::vector<double>{1, 2, 3, 4, 5}, "pN")}};
}

}  // namespace

TEST(Paraview, Bodies_are_closed_surfaces_with_outward_triangles) {
  PolyMesh const mesh = body_mesh(scene_with_a_ball(), frame_with_two_fibers());
  EXPECT_EQ(mesh.triangles.size(), 2 * mesh.points.size() - 4);  // Euler's formula of a sphere
  double volume = 0.0;
  for (auto const& [a, b, c] : mesh.triangles)
    volume += dot(mesh.points[a], cross(mesh.points[b], mesh.points[c])) / 6.0;
  EXPECT_NEAR(volume, 4.0 / 3.0 * std::numbers::pi * 8.0, 0.4);  // 24 rings of a polyhedron inside the sphere
}

TEST(Paraview, Fibers_run_from_minus_to_plus_end_with_their_tension) {
  PolyMesh const mesh = fiber_mesh(frame_with_two_fibers());
  ASSERT_EQ(mesh.lines.size(), 2u);
  EXPECT_EQ(mesh.lines[0], (std::vector<std::int64_t>{0, 1, 2, 3}));
  EXPECT_EQ(mesh.points[3].x, 3.0);
  EXPECT_EQ(mesh.points[8].y, 4.0);
  ASSERT_EQ(mesh.point_arrays.size(), 1u);
  EXPECT_EQ(mesh.point_arrays[0].name, "tension");
  EXPECT_EQ(std::get<std::vector<double>>(mesh.point_arrays[0].values), (std::vector<double>{1, 1, 2, 2, 3, 3, 4, 5, 5}));
}

TEST(Paraview, A_scene_without_fibers_has_no_fiber_mesh) {
  EXPECT_TRUE(fiber_mesh({0.0, {}}).points.empty());
  EXPECT_TRUE(periphery_mesh(scene_with_a_ball()).points.empty());
}

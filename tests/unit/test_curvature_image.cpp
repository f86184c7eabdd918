#include "surface/curvature_image.hpp"

#include "kernels/stokeslet.hpp"
#include "surface/image_wall.hpp"
#include "surface/shell_operator.hpp"

#include <gtest/gtest.h>

using namespace asterflow;

namespace {

constexpr double distance = 0.7;
Vec3d const normal{0, 0, 1};

// 8 pi x flow of a force at the distance d from the plane z = 0 with its image behind it [Blake 1971].
Vec3d plane_flow(Vec3d f, double d, Vec3d x) {
  Vec3d const direct = x - d * normal, r = x + d * normal, a = f - 2.0 * f.z * normal;
  double const s = 1.0 / norm(r), s3 = s * s * s, s0 = 1.0 / norm(direct), r_f = dot(r, f), r_a = dot(r, a);
  double const along_a = 2.0 * d * s3 * (d - r.z);
  return s0 * f + s0 * s0 * s0 * dot(direct, f) * direct + (along_a - s) * f +
         (s3 * (2.0 * d * f.z - r_f) - 3.0 * s * s * along_a * r_a) * r + (2.0 * d * s3 * r_a - 2.0 * f.z * along_a) * normal;
}

// Velocity of a force with its images at the wall z = (k_1 x^2 + k_2 y^2) / 2; largest at a few points of it.
double largest_slip(Vec3d force, double k_1, double k_2) {
  LocalGeometry const wall{{{1, 0, 0}, {0, 1, 0}}, {k_1, k_2}, 1.0};
  CurvatureImage<double> const curvature(force, {}, normal, distance, wall);
  double largest = 0.0;
  for (double const r : {0.1, 0.5, 1.0, 3.0})
    for (int k = 0; k < 9; ++k) {
      double const x = r * std::cos(0.7 * k), y = r * std::sin(0.7 * k);
      PointArray const point{{x, y, 0.5 * (k_1 * x * x + k_2 * y * y)}};
      LanesOfVectors<double> u;
      curvature.add(gather<double>(point, 0, 1), u);
      Vec3d const slip = plane_flow(force, distance, point[0]) + Vec3d{u.x[0], u.y[0], u.z[0]};
      largest = std::max(largest, Stokeslet::prefactor * norm(slip));
    }
  return largest;
}

Surface surface(std::vector<std::array<double, 2>> const& profile) {
  ShapeSpec const spec{.kind = ShapeSpec::Kind::revolution, .profile = profile};
  return Surface(make_shape(spec), 10);
}

}  // namespace

TEST(CurvatureImage, leaves_the_square_of_the_curvature_of_any_force) {
  for (Vec3d const force : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}, Vec3d{0.3, -0.5, 0.7}}) {
    double const slip = largest_slip(force, 3e-3, 11e-3);
    EXPECT_LT(slip, 2e-5 * norm(force));  // a plane image leaves 4e-4
    EXPECT_NEAR(largest_slip(force, 3e-4, 11e-4) / slip, 0.01, 5e-4);
  }
}

// k_1 = b / a^2 along the meridian, k_2 = 1 / b across at the equator; both a / b^2 at the pole.
TEST(LocalGeometry, of_an_ellipsoid_has_its_curvatures) {
  ShapeSpec const spec{.kind = ShapeSpec::Kind::ellipsoid, .semi_axes = {25, 15, 15}};
  LocalGeometry const equator = local_geometry(*make_shape(spec), {0, 0, 1}), pole = local_geometry(*make_shape(spec), {1, 0, 0});
  EXPECT_NEAR(equator.curvature[0], 1.0 / 15, 1e-7);
  EXPECT_NEAR(equator.curvature[1], 15.0 / 625, 1e-7);
  EXPECT_NEAR(std::abs(equator.tangent[0].y), 1.0, 1e-6);
  EXPECT_NEAR(equator.stretch, std::sqrt(25.0 * 15.0), 1e-9);
  for (double const curvature : pole.curvature) EXPECT_NEAR(curvature, 25.0 / 225, 1e-7);
}

TEST(ImageWall, follows_the_curvature_of_an_egg_from_inside_where_asked) {
  Surface const egg = surface({{-9, 0}, {-8, 5}, {-4, 9}, {0, 10}, {5, 8}, {9, 4.6}, {11, 0}});
  EXPECT_TRUE(ImageWall(egg, Side::interior, true).has_curvature());
  EXPECT_FALSE(ImageWall(egg, Side::interior, false).has_curvature());
  EXPECT_FALSE(ImageWall(egg, Side::exterior, true).has_curvature());
}

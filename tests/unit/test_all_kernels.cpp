#include "kernels/list.hpp"

#include <gtest/gtest.h>

using namespace asterflow;

TEST(Stokeslet, velocity_along_the_force_is_twice_that_across_it) {
  Vec3d const force{2.0, 0.0, 0.0};
  Vec3d const along = Stokeslet::velocity(Vec3d{3.0, 0.0, 0.0}, force);
  Vec3d const across = Stokeslet::velocity(Vec3d{0.0, 3.0, 0.0}, force);
  EXPECT_DOUBLE_EQ(along.x, 2.0 * across.x);
  EXPECT_DOUBLE_EQ(across.x, 2.0 / (8.0 * M_PI * 3.0));
}

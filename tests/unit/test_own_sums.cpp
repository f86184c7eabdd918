#include "system/own_sums.hpp"

#include "kernels/stokeslet.hpp"

#include <gtest/gtest.h>
#include <random>

using namespace asterflow;

namespace {

template <class Real>
void compare_with_pairs(Vec3d centre, double tolerance) {
  std::vector<std::size_t> const first{0, 5, 5, 24};  // below a vector register, none, above
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  PointArray positions(24), strengths(24), velocity(24);
  for (auto* points : {&positions, &strengths, &velocity})
    for (Vec3d& p : *points) p = {number(random), number(random), number(random)};
  for (Vec3d& p : positions) p += centre;
  positions[8] = positions[7];  // a node on another feels nothing of it
  PointArray expected = velocity;
  for (std::size_t fiber = 0; fiber + 1 < first.size(); ++fiber)
    for (std::size_t i = first[fiber]; i < first[fiber + 1]; ++i)
      for (std::size_t j = first[fiber]; j < first[fiber + 1]; ++j)
        expected[i] -= Stokeslet::velocity(positions[i] - positions[j], strengths[j]);
  subtract_own_sums<Real>(positions, first, strengths, velocity);
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_LT(norm(velocity[i] - expected[i]), tolerance);
}

}  // namespace

TEST(OwnSums, TakesOutTheSumOverTheNodesOfTheSameFiber) { compare_with_pairs<double>({}, 1e-14); }

TEST(OwnSums, HoldsInFloatFarFromTheOrigin) { compare_with_pairs<float>({3000.0, -400.0, 70.0}, 2e-6); }

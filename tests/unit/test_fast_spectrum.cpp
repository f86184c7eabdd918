#include "backends/fast_spectrum.hpp"

#include "backends/fast_fourier.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace asterflow {
namespace {

// The sweeps of a patch ask whether a wave number is within the band: a mode kept must not be beyond it by rounding.
TEST(Fast_spectrum, keeps_modes_within_the_band_only) {
  for (int percent = 105; percent <= 200; ++percent)
    for (int n = transform_length(8); n <= 240; n = transform_length(n + 1)) {
      double const band = M_PI / (0.01 * percent);
      int const nodes[3] = {n, 8, 8};
      auto const one = [](double) { return 1.0; };
      auto const table = make_symbol<float>(nodes, band, 1, one, one);
      double const k = 2.0 * M_PI / n;
      EXPECT_LT(k * table.modes[0], band) << n << " nodes, band " << band;
      EXPECT_GT(k * (table.modes[0] + 1) * (1.0 + 1e-11), band) << n << " nodes, band " << band;
    }
}

}  // namespace
}  // namespace asterflow

#include "backends/fast_split.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace asterflow {
namespace {

// Of polynomials [term, piece] at a place counted in pieces.
double value(std::vector<double> const& coefficients, int pieces, int terms, double place) {
  int const piece = std::clamp(static_cast<int>(std::lround(place)), 0, pieces - 1);
  double sum = 0.0;
  for (int k = terms - 1; k >= 0; --k) sum = sum * (place - piece) + coefficients[k * pieces + piece];
  return sum;
}

// What LocalPart says of first and second of OuterPart.
struct Factors {
  double first, second;
};
Factors factors(std::string const& kernel, double r, double a, double b) {
  if (kernel == "stokeslet") return {1.0 / r - a, std::pow(r, -3) - b};
  if (kernel == "rotlet") return {0.0, std::pow(r, -3) - b};
  if (kernel == "stokeslet_pressure") return {0.0, 2.0 * (std::pow(r, -3) - b)};
  if (kernel == "stresslet") return {-a, -6.0 * (std::pow(r, -5) - b)};
  return {4.0 * (std::pow(r, -3) - a), -12.0 * (std::pow(r, -5) - b)};
}

TEST(Kernel_split, has_an_outer_part_that_is_the_local_part_from_some_distance_on) {
  constexpr int pieces = 16, most_terms = 7;
  for (std::string const kernel : {"stokeslet", "stresslet", "rotlet", "stokeslet_pressure", "stresslet_pressure"})
    for (int digits : {7, 9, 10}) {
      KernelSplit const split(2.45 * digits + 3.0);
      double const tolerance = 0.5 * std::pow(10.0, -digits);
      LocalPart const local = split.local_part(kernel, 1e-13, 1);
      OuterPart const outer = split.outer_part(kernel, tolerance, pieces, most_terms);
      ASSERT_GT(outer.terms, 0) << kernel << " " << digits;
      EXPECT_LE(outer.terms, most_terms);
      EXPECT_LT(outer.begin, 0.95);
      // Sizes at the cutoff are up to 12; terms left out of A and B of the stresslet's pressure are large in absolute terms.
      double const largest = *std::max_element(local.b.begin(), local.b.end(), [](double x, double y) { return std::abs(x) < std::abs(y); });
      double const bound = 12.0 * (tolerance + 1e-14 * std::abs(largest));
      for (double r = outer.begin; r < 1.0; r += 0.003) {
        double const x = r * r - 0.5, place = outer.to_pieces * (r * r - 1.0) + pieces - 0.5;
        Factors const f = factors(kernel, r, value(local.a, 1, local.terms, x), value(local.b, 1, local.terms, x));
        if (kernel != "rotlet" && kernel != "stokeslet_pressure") {
          EXPECT_NEAR(value(outer.first, pieces, outer.terms, place), f.first, bound) << kernel << " " << digits << " " << r;
        }
        EXPECT_NEAR(value(outer.second, pieces, outer.terms, place), f.second, bound) << kernel << " " << digits << " " << r;
      }
    }
}

}  // namespace
}  // namespace asterflow

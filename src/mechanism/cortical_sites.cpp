#include "mechanism/cortical_sites.hpp"

#include "base/polar_directions.hpp"
#include "base/random.hpp"
#include "base/rigid.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace asterflow {
namespace {

constexpr std::uint64_t site_stream = 0x736974657300ull;  // keeps sites apart from fibers' own chance
enum Draw : std::uint64_t { height, turn, acceptance };

Vec3d random_direction(std::uint64_t seed, std::uint64_t site, std::uint64_t attempt) {
  double const z = 2 * uniform_random(seed, site_stream + site, attempt, height) - 1;
  double const phi = 2 * std::numbers::pi * uniform_random(seed, site_stream + site, attempt, turn);
  double const r = std::sqrt(std::max(0.0, 1 - z * z));
  return {r * std::cos(phi), r * std::sin(phi), z};
}

// Area of the surface over that of the unit sphere, um^2: |cof(J) d| for the map's derivative J across d.
double area_ratio(Shape const& shape, Vec3d direction) {
  auto const image = shape.image(direction);
  PolarDirections const across(normalized(direction));
  return norm(cross(image.jacobian * across.first, image.jacobian * across.second));
}

}  // namespace

PointArray random_sites(Shape const& shape, int count, std::uint64_t seed) {
  double largest = 0.0;
  for (int i = 0; i < 4000; ++i)
    largest = std::max(largest, area_ratio(shape, random_direction(seed, std::uint64_t(-1), i)));
  largest *= 1.05;
  PointArray sites;
  for (int site = 0; site < count; ++site)
    for (std::uint64_t attempt = 0;; ++attempt) {
      Vec3d const direction = random_direction(seed, site, attempt);
      double const chance = uniform_random(seed, site_stream + site, attempt, acceptance);
      if (chance * largest > area_ratio(shape, direction)) continue;
      sites.push_back(shape.image(direction).position);
      break;
    }
  return sites;
}

PointArray even_sites(Shape const& shape, Vec3d axis, int count) {
  PolarDirections const at(normalized(axis));
  constexpr int n_ring = 2000, n_turn = 16;
  std::vector<double> area(n_ring + 1, 0.0);  // below each height -1 + 2 i / n_ring, up to a factor
  for (int i = 0; i < n_ring; ++i) {
    area[i + 1] = area[i];
    for (int j = 0; j < n_turn; ++j)
      area[i + 1] += area_ratio(shape, at((2.0 * i + 1) / n_ring - 1, 2 * std::numbers::pi * j / n_turn));
  }
  PointArray sites;
  for (int site = 0, ring = 0; site < count; ++site) {
    double const wanted = (site + 0.5) / count * area[n_ring];
    while (area[ring + 1] < wanted) ++ring;
    double const part = (wanted - area[ring]) / (area[ring + 1] - area[ring]);
    sites.push_back(shape.image(at(2 * (ring + part) / n_ring - 1, golden_angle * site)).position);
  }
  return sites;
}

}  // namespace asterflow

#include "system/close_nodes.hpp"

#include "base/parallel.hpp"
#include "kernels/stokeslet.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace asterflow {
namespace {

constexpr long block_size = 128;  // nodes
constexpr double radius_per_weight = 0.3;  // from 0.25 to 0.4 bundles are solved
constexpr double reach = 1.25;             // over a + b

struct Factors {
  double one, outer;  // of I and r r / r^2, 1/um
};

// Of the flow between spheres of radii a, b at the distance r, over 8 pi mu.
Factors between_spheres(double a, double b, double r) {
  double const sum = a + b, difference = a - b;
  if (r <= std::abs(difference)) return {4.0 / (3.0 * std::max(a, b)), 0.0};
  if (r >= sum) {
    double const y = std::clamp((r / sum - 1.0) / (reach - 1.0), 0.0, 1.0);
    double const q = (a * a + b * b) / (r * r) * (1.0 - y * y * (3.0 - 2.0 * y));
    return {(1.0 + q / 3.0) / r, (1.0 - q) / r};
  }
  double const r2 = r * r, r3 = r2 * r, d2 = difference * difference, scale = 1.0 / (24.0 * a * b * r3);
  return {scale * (16.0 * r3 * sum - (d2 + 3.0 * r2) * (d2 + 3.0 * r2)), 3.0 * scale * (d2 - r2) * (d2 - r2)};
}

// Points sorted by the cubes that hold them, row after row of cubes along x.
class CubeRows {
 public:
  CubeRows(ConstPoints points, double side) : side_(side), order_(points.size()) {
    std::vector<std::int64_t> key;
    for (Vec3d const x : points) key.push_back(key_of(index(x.x), index(x.y), index(x.z)));
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) { return std::pair(key[a], a) < std::pair(key[b], b); });
    for (std::size_t const i : order_) keys_.push_back(key[i]);
  }

  // body(j) for all points j in the cube of x and its neighbours.
  template <class Body>
  void for_near(Vec3d x, Body const& body) const {
    std::int64_t const ix = index(x.x), iy = index(x.y), iz = index(x.z);
    for (std::int64_t z = iz - 1; z <= iz + 1; ++z)
      for (std::int64_t y = iy - 1; y <= iy + 1; ++y) {
        auto const begin = std::lower_bound(keys_.begin(), keys_.end(), key_of(ix - 1, y, z));
        auto const end = std::upper_bound(begin, keys_.end(), key_of(ix + 1, y, z));
        for (auto at = begin; at != end; ++at) body(order_[at - keys_.begin()]);
      }
  }

 private:
  static constexpr std::int64_t most = (1 << 20) - 2;  // cubes from the origin; what lies further shares the last one
  std::int64_t index(double x) const {
    return static_cast<std::int64_t>(std::clamp(std::floor(x / side_), -double(most), double(most)));
  }
  static std::int64_t key_of(std::int64_t x, std::int64_t y, std::int64_t z) {
    return ((z + most + 1) << 42) + ((y + most + 1) << 21) + (x + most + 1);
  }

  double side_;  // um
  std::vector<std::size_t> order_;
  std::vector<std::int64_t> keys_;  // in this order
};

}  // namespace

void CloseNodes::find(ConstPoints positions, ConstVector weights, std::vector<std::size_t> const& first) {
  auto const n = static_cast<long>(positions.size());
  blocks_.assign((n + block_size - 1) / block_size, {});
  if (n == 0) return;
  CubeRows const cubes(positions, 2.0 * reach * radius_per_weight * *std::max_element(weights.begin(), weights.end()));
  parallel_for("CloseNodes::find", static_cast<long>(blocks_.size()), [&](long block) {
    for (long at = block * block_size; at < std::min(n, (block + 1) * block_size); ++at) {
      auto const i = static_cast<std::size_t>(at);
      auto const end = std::upper_bound(first.begin(), first.end(), i);  // of its fiber
      cubes.for_near(positions[i], [&](std::size_t j) {
        if (j >= *(end - 1) && j < *end) return;
        double const a = radius_per_weight * weights[i], b = radius_per_weight * weights[j];
        Vec3d const r = positions[i] - positions[j];
        double const r2 = dot(r, r);
        if (r2 >= reach * reach * (a + b) * (a + b)) return;
        double const distance = std::sqrt(r2), inverse = r2 > 0.0 ? 1.0 / distance : 0.0;  // at r = 0 sums leave it out
        Factors const mean = between_spheres(a, b, distance);
        blocks_[block].push_back({i, j, r, Stokeslet::prefactor * (mean.one - inverse),
                                  Stokeslet::prefactor * (mean.outer - inverse) * inverse * inverse});
      });
    }
  });
}

void CloseNodes::add_correction(ConstPoints strengths, Points velocity) const {
  parallel_for("CloseNodes::add_correction", static_cast<long>(blocks_.size()), [&](long block) {
    for (Pair const& pair : blocks_[block]) {
      Vec3d const f = strengths[pair.source];
      velocity[pair.target] += pair.one * f + (pair.outer * dot(pair.r, f)) * pair.r;
    }
  });
}

std::size_t CloseNodes::count() const {
  std::size_t n = 0;
  for (auto const& block : blocks_) n += block.size();
  return n;
}

}  // namespace asterflow

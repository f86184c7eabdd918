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
constexpr double delta_per_weight = 0.25;

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
  CubeRows const cubes(positions, delta_per_weight * *std::max_element(weights.begin(), weights.end()));
  parallel_for("CloseNodes::find", static_cast<long>(blocks_.size()), [&](long block) {
    for (long at = block * block_size; at < std::min(n, (block + 1) * block_size); ++at) {
      auto const i = static_cast<std::size_t>(at);
      auto const end = std::upper_bound(first.begin(), first.end(), i);  // of its fiber
      cubes.for_near(positions[i], [&](std::size_t j) {
        if (j >= *(end - 1) && j < *end) return;
        double const delta = 0.5 * delta_per_weight * (weights[i] + weights[j]);
        Vec3d const r = positions[i] - positions[j];
        double const x2 = dot(r, r) / (delta * delta);
        if (x2 >= 1.0) return;
        double const stokeslet = x2 > 0.0 ? 1.0 / std::sqrt(x2) : 0.0;  // delta / r; at r = 0 sums leave it out
        double const one = 0.5 * (3.0 - x2) - stokeslet, outer = 0.5 * (5.0 - 3.0 * x2) - stokeslet * stokeslet * stokeslet;
        double const scale = Stokeslet::prefactor / delta;
        blocks_[block].push_back({i, j, r, scale * one, scale / (delta * delta) * outer});
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

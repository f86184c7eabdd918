#include "backends/fast_crowding.hpp"

#include "backends/fast_window.hpp"
#include "base/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace asterflow {
namespace {

constexpr int width = 8, n_node = 40;
constexpr double shape = 15.8;

PointArray points(long n, double low, double high) {
  PointArray x(n);
  for (long i = 0; i < n; ++i)
    for (int d = 0; d < 3; ++d) x[i][d] = low + (high - low) * uniform_random(3, i, d, 0);
  return x;
}

// Sum of the weights of all points at every node [z, y, x] of the periodic grid.
std::vector<double> sums_of_weights(PatchView<float> const& grid, PointArray const& points) {
  KaiserBessel const window(shape);
  std::vector<double> sums(n_node * n_node * n_node, 0.0);
  for (Vec3d const& p : points) {
    int node[3][width];
    double weight[3][width];
    for (int d = 0; d < 3; ++d) {
      double const xi = (p[d] - grid.corner[d]) * grid.to_nodes, first = std::floor(xi);
      for (int j = 0; j < width; ++j) {
        node[d][j] = (static_cast<int>(first) + j + n_node) % n_node;
        weight[d][j] = window.value((j - 0.5 * width + first - xi + 1.0) * 2.0 / width);
      }
    }
    for (int i = 0; i < width * width * width; ++i) {
      int const x = i % width, y = i / width % width, z = i / width / width;
      sums[(node[2][z] * n_node + node[1][y]) * n_node + node[0][x]] += weight[0][x] * weight[1][y] * weight[2][z];
    }
  }
  return sums;
}

// The bound over the largest sum, of every tile.
std::vector<double> bounds_over_sums(PointArray const& x) {
  GridWindow<float> const window(width, shape, true);
  Patch<float> patch;
  for (int& n : patch.nodes) n = n_node;
  patch.spacing = 1.0 / n_node;
  std::vector<Range> const all{{0, static_cast<long>(x.size())}};
  window.find_reach(patch, {x, all}, patch.source_low, patch.source_high);
  window.find_reach(patch, {x, all}, patch.target_low, patch.target_high);
  patch.set_tiles(16, width);
  auto const sums = sums_of_weights(window.view(patch, 1), x);
  auto const bounds = crowding(window, patch, x, all);
  std::vector<double> ratios;
  for (long tile = 0; tile < patch.n_tile(); ++tile) {
    auto const [y_begin, y_end, z_begin, z_end] = patch.tile_nodes(tile);
    double largest = 0.0;
    for (int z = z_begin; z < z_end; ++z)
      for (int y = y_begin; y < y_end; ++y)
        for (int i = 0; i < n_node; ++i) largest = std::max(largest, sums[(z * n_node + y) * n_node + i]);
    ratios.push_back(bounds[tile] / largest);
  }
  return ratios;
}

TEST(Fast_crowding, bounds_the_sum_of_weights_at_every_node_of_a_tile) {
  for (auto const& x : {points(3000, 0.3, 0.6), points(3000, 0.0, 1.0), points(1, 0.5, 0.5), points(500, 0.51, 0.5101)})
    for (double ratio : bounds_over_sums(x)) {
      EXPECT_GE(ratio, 1.0 - 1e-6);  // float
      EXPECT_LT(ratio, 30.0);        // weights of two cells may count at each end of three directions
    }
}

}  // namespace
}  // namespace asterflow

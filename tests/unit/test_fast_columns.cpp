#include "backends/backend.hpp"
#include "backends/fast_fourier.hpp"
#include "backends/fast_grid.hpp"
#include "backends/fast_spectrum.hpp"
#include "base/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace asterflow {
namespace {

constexpr int n_node = 48;

PointArray points(long n, double low, double high) {
  PointArray x(n);
  for (long i = 0; i < n; ++i)
    for (int d = 0; d < 3; ++d) x[i][d] = low + (high - low) * uniform_random(3, i, d, 0);
  return x;
}

std::vector<double> numbers(std::size_t n) {
  std::vector<double> x(n);
  for (std::size_t i = 0; i < n; ++i) x[i] = uniform_random(5, static_cast<long>(i), 0, 0) - 0.5;
  return x;
}

// Memory of vectors.
struct Work {
  std::vector<double> memory;
  explicit Work(long n) : memory(n + 8) {}
  double* data() { return reinterpret_cast<double*>((reinterpret_cast<std::uintptr_t>(memory.data()) + 63) / 64 * 64); }
};

// A period of n_node nodes of the unit cube with the same points as sources and targets.
struct Grid {
  GridWindow<double> window;
  Patch<double> patch;
  LineTransform<double> line{n_node};
  PointArray x;

  Grid(int width, PointArray const& places) : window(width, 2.3 * width, false), x(places) {
    for (int d = 0; d < 3; ++d) patch.nodes[d] = n_node, patch.lines[d] = line.view();
    patch.spacing = 1.0 / n_node;
    auto const one = [](double) { return 1.0; };
    patch.symbol = std::make_shared<SymbolTable<double>>(make_symbol<double>(patch.nodes, 2.5, 8, one, one));
    std::vector<Range> const all{{0, static_cast<long>(x.size())}};
    window.find_reach(patch, {x, all}, patch.source_low, patch.source_high);
    window.find_reach(patch, {x, all}, patch.target_low, patch.target_high);
    patch.set_tiles(16, width);
    patch.sources = patch.targets = window.tile(patch, x, all);
  }
};

std::vector<double> spread(FastLoops<double> const& loops, Grid const& grid, bool in_columns, int components) {
  auto patch = grid.window.view(grid.patch, loops.lanes);
  if (!in_columns) patch.sources.column = nullptr;
  auto const window = grid.window.view();
  Work spectrum(2L * components * patch.planes * (patch.modes[0] + 1) * patch.spectrum_row);
  Work scratch(loops.forward_scratch(window, patch, components));
  auto const strengths = numbers(grid.x.size() * components);
  for (long tile = 0; tile < grid.patch.n_tile(); ++tile)
    loops.forward(window, patch, components, tile, &grid.x[0].x, strengths.data(), spectrum.data(), scratch.data());
  return {spectrum.data(), spectrum.data() + spectrum.memory.size() - 8};
}

std::vector<double> interpolate(FastLoops<double> const& loops, Grid const& grid, bool in_columns) {
  auto patch = grid.window.view(grid.patch, loops.lanes);
  if (!in_columns) patch.targets.column = nullptr;
  long const n = 3L * patch.velocity_row * (patch.target_high[1] - patch.target_low[1]) * (patch.target_high[2] - patch.target_low[2]);
  Work nodes(n);
  std::ranges::copy(numbers(n), nodes.data());
  std::vector<double> velocity(3 * grid.x.size(), 0.0);
  for (long tile = 0; tile < grid.patch.n_tile(); ++tile)
    loops.interpolate(grid.window.view(), patch, tile, &grid.x[0].x, nodes.data(), velocity.data(), nullptr);
  return velocity;
}

double largest_difference(std::vector<double> const& a, std::vector<double> const& b) {
  double difference = 0.0, size = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference = std::max(difference, std::abs(a[i] - b[i]));
    size = std::max(size, std::abs(a[i]));
  }
  return difference / size;
}

// Of every instruction set of this machine.
std::vector<FastLoops<double>> all_loops() {
  std::vector<FastLoops<double>> all{fast_loops_portable<double>()};
#if defined(__x86_64__)
  if (has_avx2()) all.push_back(fast_loops_avx2<double>());
  if (has_avx512()) all.push_back(fast_loops_avx512<double>());
#endif
  return all;
}

// Many points and few, within the period and beyond it (from its last nodes to its first), and all in one column.
std::vector<PointArray> clouds() {
  return {points(4000, 0.3, 0.6), points(6000, 0.0, 1.0), points(200, 0.0, 1.0), points(300, 0.51, 0.52), points(1, 0.99, 0.99)};
}

TEST(Fast_columns, hold_points_whose_windows_lie_within_their_nodes) {
  for (int width = 8; width <= 13; ++width) {
    Grid const grid(width, points(20000, 0.0, 1.0));
    auto const view = grid.window.view(grid.patch, 8);
    auto const& sources = grid.patch.sources;
    for (long tile = 0; tile < grid.patch.n_tile(); ++tile)
      for (long k = sources.tile_begin[tile] + 1; k < sources.tile_begin[tile + 1]; ++k) {
        if (sources.column[k] != sources.column[k - 1]) continue;
        int before[3], now[3];
        for (int d = 0; d < 3; ++d) {
          before[d] = grid.window.first_node(view, grid.x[sources.index[k - 1]], d);
          now[d] = grid.window.first_node(view, grid.x[sources.index[k]], d);
        }
        EXPECT_LE(std::abs(before[0] - now[0]) + width, PointColumn::nodes);
        EXPECT_LT(std::abs(before[1] - now[1]), PointColumn::rows_at_once);
        EXPECT_LE(before[2], now[2]);
      }
  }
}

// 1e-13: rounding of sums of up to 1e4 numbers in another order.
TEST(Fast_columns, spread_as_points_do_one_by_one) {
  for (auto const& loops : all_loops())
    for (int width : {8, 10, 13})
      for (auto const& cloud : clouds())
        for (int components : {3, 6}) {
          Grid const grid(width, cloud);
          EXPECT_LT(largest_difference(spread(loops, grid, false, components), spread(loops, grid, true, components)), 1e-13)
              << loops.lanes << " lanes, width " << width << ", points " << cloud.size();
        }
}

TEST(Fast_columns, are_interpolated_as_points_one_by_one) {
  for (auto const& loops : all_loops())
    for (int width : {8, 10, 13})
      for (auto const& cloud : clouds()) {
        Grid const grid(width, cloud);
        if (grid.patch.target_high[0] - grid.patch.target_low[0] == n_node) continue;  // targets' windows do not go beyond the period
        EXPECT_LT(largest_difference(interpolate(loops, grid, false), interpolate(loops, grid, true)), 1e-13);
      }
}

}  // namespace
}  // namespace asterflow

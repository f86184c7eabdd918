#include "backends/fast_order.hpp"

#include "backends/blocks.hpp"
#include "backends/fast_sort.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace asterflow {
namespace {

// Seven bits, each followed by two zeros.
constexpr auto spread_seven = [] {
  std::array<std::uint32_t, 128> spread{};
  for (std::uint32_t x = 0; x < 128; ++x)
    for (int bit = 0; bit < 7; ++bit) spread[x] |= (x >> bit & 1u) << 3 * bit;
  return spread;
}();

std::uint64_t spread_bits(std::uint64_t x) {
  auto const part = [x](int i) { return std::uint64_t{spread_seven[x >> 7 * i & 127]} << 21 * i; };
  return part(0) | part(1) | part(2);
}

void extend(ConstPoints points, Vec3d& low, Vec3d& high) {
  for (Vec3d const& p : points)
    for (int d = 0; d < 3; ++d) {
      low[d] = p[d] < low[d] ? p[d] : low[d];
      high[d] = p[d] > high[d] ? p[d] : high[d];
    }
}

// The square of the largest distance from a point.
double largest_square(ConstPoints points, Vec3d const& from) {
  double largest = 0.0;
  for (Vec3d const& p : points) largest = std::max(largest, dot(p - from, p - from));
  return largest;
}

}  // namespace

bool is_same(ConstPoints a, ConstPoints b) {
  auto const same = [](Vec3d const& x, Vec3d const& y) { return x.x == y.x && x.y == y.y && x.z == y.z; };
  return a.size() == b.size() && (a.data() == b.data() || std::equal(a.begin(), a.end(), b.begin(), same));
}

std::uint64_t morton_key(std::uint64_t x, std::uint64_t y, std::uint64_t z) {
  return spread_bits(x) | spread_bits(y) << 1 | spread_bits(z) << 2;
}

int morton_coordinate(std::uint64_t key, int direction) {
  std::uint64_t x = (key >> direction) & 0x1249249249249249;
  x = (x | x >> 2) & 0x10c30c30c30c30c3;
  x = (x | x >> 4) & 0x100f00f00f00f00f;
  x = (x | x >> 8) & 0x1f0000ff0000ff;
  x = (x | x >> 16) & 0x1f00000000ffff;
  return static_cast<int>((x | x >> 32) & 0x1fffff);
}

RootCube::RootCube(ConstPoints sources, ConstPoints targets, double enlargement) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  Vec3d low{infinite, infinite, infinite}, high{-infinite, -infinite, -infinite};
  bool const is_self = is_same(sources, targets);
  extend(sources, low, high);
  if (!is_self) extend(targets, low, high);
  extent = high - low;
  double const widest = std::max({extent.x, extent.y, extent.z});
  side = widest > 0.0 ? widest * enlargement * (1.0 + 1e-9) : 1.0;
  extent = extent / side;
  Vec3d const middle = low + 0.5 * (high - low);
  double const radius = std::sqrt(std::max(largest_square(sources, middle), is_self ? 0.0 : largest_square(targets, middle)));
  largest_distance = std::min(norm(extent), 2.0 * (1.0 + 1e-9) * radius / side);
  int exponent = 0;
  unit_side = std::frexp(side, &exponent);
  double const unit = std::ldexp(1.0, exponent);
  for (int d = 0; d < 3; ++d) origin[d] = std::abs(low[d]) < 4.0 * unit ? 0.0 : std::floor(low[d] / unit) * unit;
  corner = (low - origin) * (1.0 / unit);
}

void find_keys(ConstPoints points, long begin, long end, RootCube const& cube, KeyedIndex* items) {
  constexpr double cells = static_cast<double>(1 << morton_levels);
  double const to_cells = cells / cube.unit_side;
  auto const cell = [&](double x) { return static_cast<std::uint64_t>(static_cast<long>(std::clamp(x * to_cells, 0.0, cells - 1.0))); };
  for (long i = begin; i < end; ++i) {
    Vec3d const x = cube.placed(points[i]) - cube.corner;
    items[i] = {spread_bits(cell(x.x)) | spread_bits(cell(x.y)) << 1 | spread_bits(cell(x.z)) << 2, static_cast<std::uint32_t>(i)};
  }
}

std::vector<KeyedIndex> sorted_keys(ConstPoints points, RootCube const& cube) {
  std::vector<KeyedIndex> items(points.size());
  constexpr long block = 2048;
  long const n = static_cast<long>(points.size());
  parallel_for("Fast::morton_keys", (n + block - 1) / block,
               [&](long i) { find_keys(points, i * block, std::min(n, (i + 1) * block), cube, items.data()); });
  sort_by_key(items);
  return items;
}

OrderedPoints order_points(ConstPoints points, RootCube const& cube) {
  auto const items = sorted_keys(points, cube);
  OrderedPoints ordered;
  ordered.keys.resize(items.size());
  ordered.order.resize(items.size());
  ordered.points.resize(items.size());
  for_blocks("Fast::order_points", static_cast<long>(items.size()), [&](long i) {
    ordered.keys[i] = items[i].key;
    ordered.order[i] = items[i].index;
    ordered.points[i] = cube.placed(points[items[i].index]);
  });
  return ordered;
}

}  // namespace asterflow

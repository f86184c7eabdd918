#include "backends/fast_plan.hpp"

#include "backends/fast_cover.hpp"
#include "backends/fast_kernel.hpp"
#include "backends/finite.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace asterflow {
namespace {

// Measured on one core with AVX-512 (Zen 4).
struct Costs {
  double pair, node, point;  // ns per pair, grid node and point of a patch
};

Costs costs(FastParameters const& p, int components) {
  double const terms = 0.9 * p.split_shape - 2.0, width2 = static_cast<double>(p.width) * p.width;
  double const in_float = 4.0 * width2 + 100.0, in_double = 7.2 * width2 + 96.0;
  double const spread = p.sums_in_double ? in_double : in_float, interpolate = p.single ? in_float : in_double;
  double const pair = (p.single ? 0.019 : 0.038) * (25.0 + 2.0 * terms);
  return {pair, (p.single ? 1.5 : 3.7) * (components + 3), components / 6.0 * spread + 0.5 * interpolate};
}

// Of the 27 boxes around a leaf with n targets, the part that a group of `lanes` of them has within the cutoff: the
// cutoff's ball around a box of side a, less what the corners of the box do not reach.
double part_within_cutoff(double n, double lanes) {
  double const a = std::min(1.0, std::cbrt(lanes / std::max(n, 1.0)));
  return 0.85 * (a * a * a + 6.0 * a * a + 3.0 * M_PI * a + 4.0 / 3.0 * M_PI) / 27.0;
}

// Pairs in the lists of a tree that holds one of every `thinning` points.
double near_pairs(Octree const& tree, double thinning, double lanes) {
  double pairs = 0.0;
  for (std::size_t level = 0; level < tree.leaves().size(); ++level)
    for (Box const& box : tree.leaves()[level]) {
      double const part = part_within_cutoff(thinning * static_cast<double>(box.targets.size()), lanes);
      for (int i = 0; i < 27; ++i) {
        int const x = box.place[0] + i % 3 - 1, y = box.place[1] + i / 3 % 3 - 1, z = box.place[2] + i / 9 - 1;
        if (std::min({x, y, z}) < 0) continue;
        Box const* near = Octree::find(tree.leaves()[level], x, y, z);
        if (near) {
          pairs += part * static_cast<double>(box.targets.size()) * near->sources.size();
        } else if (level < tree.refined().size() && (near = Octree::find(tree.refined()[level], x, y, z))) {
          pairs += part * static_cast<double>(box.targets.size()) * near->sources.size();
          pairs += part * static_cast<double>(box.sources.size()) * near->targets.size();
        }
      }
    }
  return pairs * thinning * thinning;
}

bool is_same(ConstPoints a, ConstPoints b) { return a.data() == b.data() && a.size() == b.size(); }

// One of every `stride` points along the Morton curve: every box keeps its share, to within one point.
class Thinned {
 public:
  Thinned(ConstPoints sources, ConstPoints targets, long stride) : sources_(sources), targets_(targets) {
    if (stride == 1) return;
    bool const same = is_same(sources, targets);
    Octree const order(sources, targets, {.capacity = std::numeric_limits<long>::max() / 4});
    few_sources_ = every(order.sources(), stride);
    if (!same) few_targets_ = every(order.targets(), stride);
    sources_ = few_sources_;
    targets_ = same ? few_sources_ : few_targets_;
  }
  Thinned(Thinned const&) = delete;

  ConstPoints sources() const { return sources_; }
  ConstPoints targets() const { return targets_; }

 private:
  static PointArray every(PointArray const& points, long stride) {
    PointArray few;
    for (std::size_t i = 0; i < points.size(); i += static_cast<std::size_t>(stride)) few.push_back(points[i]);
    return few;
  }

  PointArray few_sources_, few_targets_;
  ConstPoints sources_, targets_;  // those given, or the few
};

// Nodes of the grid in free space whose cutoff is the side of a box of `level`.
double root_nodes(Octree const& tree, FastParameters const& p, int level) {
  double const cutoff = std::ldexp(1.0, -level), reach = norm(tree.extent()) + cutoff;
  double nodes = 1.0;
  for (int d = 0; d < 3; ++d) nodes *= (tree.extent()[d] + reach + cutoff) * p.nodes_per_cutoff / cutoff + p.width + 2.0;
  return nodes;
}

// Of the patches of one level.
double level_cost(Octree const& tree, FastParameters const& p, Costs const& c, std::size_t level, double thinning,
                  double max_nodes) {
  double const per_box = 2.0 * p.nodes_per_cutoff;
  double cost = 0.0;
  for (Rectangle const& r : cover(tree.refined()[level], per_box, max_nodes)) {
    double nodes = 1.0;
    for (int d = 0; d < 3; ++d) nodes *= (r.high[d] - r.low[d] + 3) * per_box;
    cost += c.node * nodes;
  }
  for (Box const& box : tree.refined()[level]) cost += 0.5 * c.point * thinning * (box.sources.size() + box.targets.size());
  return cost;
}

// The cheapest first level for an octree that holds one of every `thinning` points.
Plan best_first_level(Octree const& tree, FastParameters const& p, int components, double thinning) {
  constexpr int deepest_first = 5;
  Costs const c = costs(p, components);
  double const n = 0.5 * thinning * static_cast<double>(tree.sources().size() + tree.targets().size());
  double const max_nodes = p.max_nodes(static_cast<std::size_t>(n));
  double const near = c.pair * near_pairs(tree, thinning, p.single ? 16.0 : 8.0);
  Plan best;
  double deeper = 0.0;  // levels from `first` on
  for (int first = static_cast<int>(tree.refined().size()); first >= 0; --first) {
    if (first < static_cast<int>(tree.refined().size()))
      deeper += level_cost(tree, p, c, static_cast<std::size_t>(first), thinning, max_nodes);
    double const nodes = root_nodes(tree, p, first);
    double const cost = near + deeper + c.node * nodes + c.point * n;
    if (first > deepest_first || nodes > max_nodes) continue;
    if (best.cost == 0.0 || cost < best.cost) best = {{.first_level = first}, cost};
  }
  return best;
}

}  // namespace

Plan best_plan(std::string_view kernel, ConstPoints sources, ConstPoints targets, FastParameters const& p) {
  require_finite(sources, "source");
  require_finite(targets, "target");
  int const components = n_component(fast_kernel(kernel));
  long const n = static_cast<long>(sources.size() + targets.size()) / 2;
  if (sources.empty() || targets.empty() || n <= p.capacity) return {};
  // Some of the points are enough to compare.
  long const stride = std::clamp(n / (p.single ? 2500 : 6000), 1L, 16L);
  Thinned const few(sources, targets, stride);
  Plan best;
  for (double enlargement : {1.0, 1.26, 1.59})
    for (long capacity : {p.capacity, 2 * p.capacity, 4 * p.capacity}) {
      Octree const tree(few.sources(), few.targets(), OctreeOptions{std::max(4L, capacity / stride), 0, enlargement});
      Plan plan = best_first_level(tree, p, components, static_cast<double>(stride));
      plan.octree.capacity = capacity;
      plan.octree.enlargement = enlargement;
      if (best.cost == 0.0 || (plan.cost > 0.0 && plan.cost < best.cost)) best = plan;
    }
  return best;
}

}  // namespace asterflow

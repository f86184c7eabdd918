#include "backends/fast_plan.hpp"

#include "backends/fast_cover.hpp"
#include "backends/fast_fourier.hpp"
#include "backends/fast_kernel.hpp"
#include "backends/finite.hpp"
#include "base/parallel.hpp"

#include <algorithm>
#include <cmath>

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
  double const pair = (p.single ? 0.019 : 0.038) * ((p.refinement_steps > 0 ? 25.0 : 18.0) + 2.0 * terms);
  return {pair, (p.single ? 1.5 : 3.7) * (components + 3), components / 6.0 * spread + 0.5 * interpolate};
}

// Of the 27 boxes around a leaf with n targets, the part that a group of `lanes` of them has within the cutoff: the
// cutoff's ball around a box of side a, less what the corners of the box do not reach; more where many points of a leaf
// gather in a part of it (fitted).
double part_within_cutoff(double n, double lanes) {
  double const a = std::min(1.0, std::cbrt(lanes / std::max(n, 1.0)));
  return 0.85 * (1.0 + 0.001 * n) * (a * a * a + 6.0 * a * a + 3.0 * M_PI * a + 4.0 / 3.0 * M_PI) / 27.0;
}

// One of every `stride` of some points along the Morton curve, so that every box keeps its share to within one point,
// and the boxes of octrees over them.
class Sample {
 public:
  Sample(ConstPoints sources, ConstPoints targets, long stride) : same_(is_same(sources, targets)), stride_(stride) {
    RootCube const cube(sources, targets, 1.0);
    sources_ = every(sources, cube);
    if (!same_) targets_ = every(targets, cube);
  }

  // In the cube of that size.
  struct Ordered {
    Vec3d extent;
    std::vector<std::uint64_t> source_keys, target_keys;
    bool same;
    double stride;

    OctreeBoxes boxes(long capacity) const {
      OctreeOptions const options{.capacity = std::max(4L, capacity / static_cast<long>(stride))};
      return {source_keys, same ? source_keys : target_keys, options};
    }
    double n() const { return 0.5 * stride * static_cast<double>(source_keys.size() + (same ? source_keys : target_keys).size()); }
  };
  Ordered ordered(double enlargement) const {
    RootCube const cube(sources_, same_ ? sources_ : targets_, enlargement);
    return {cube.extent, keys(sources_, cube), keys(targets_, cube), same_, static_cast<double>(stride_)};
  }

 private:
  static std::vector<std::uint64_t> keys(PointArray const& points, RootCube const& cube) {
    std::vector<std::uint64_t> keys;
    for (KeyedIndex const& item : sorted_keys(points, cube)) keys.push_back(item.key);
    return keys;
  }
  PointArray every(ConstPoints points, RootCube const& cube) const {
    if (stride_ == 1) return {points.begin(), points.end()};
    auto const order = sorted_keys(points, cube);
    PointArray few;
    for (std::size_t i = 0; i < order.size(); i += static_cast<std::size_t>(stride_)) few.push_back(points[order[i].index]);
    return few;
  }

  bool same_;
  long stride_;
  PointArray sources_, targets_;
};

// Pairs in the lists of an octree that holds one of every `stride` points.
double near_pairs(OctreeBoxes const& tree, double stride, double lanes) {
  double pairs = 0.0;
  for (int level = 0; level < static_cast<int>(tree.leaves().size()); ++level)
    for (Box const& box : tree.leaves()[level].boxes()) {
      double const part = part_within_cutoff(stride * static_cast<double>(box.targets.size()), lanes);
      for (std::uint64_t key : neighbour_keys(box.place, level)) {
        if (Box const* near = tree.leaf(level, key)) {
          pairs += part * static_cast<double>(box.targets.size()) * near->sources.size();
        } else if ((near = tree.refined_box(level, key))) {
          pairs += part * static_cast<double>(box.targets.size()) * near->sources.size();
          pairs += part * static_cast<double>(box.sources.size()) * near->targets.size();
        }
      }
    }
  return pairs * stride * stride;
}

// Nodes of the grid in free space whose cutoff is the side of a box of `level`.
double root_nodes(Vec3d extent, FastParameters const& p, int level) {
  double const cutoff = std::ldexp(1.0, -level), reach = norm(extent) + cutoff;
  double nodes = 1.0;
  for (int d = 0; d < 3; ++d)
    nodes *= transform_length(static_cast<int>(std::ceil((extent[d] + reach + cutoff) * p.nodes_per_cutoff / cutoff + p.width + 2.0)));
  return nodes;
}

// Of the patches of one level.
double level_cost(std::vector<Box> const& refined, FastParameters const& p, Costs const& c, double stride, double max_nodes) {
  double const per_box = 2.0 * p.nodes_per_cutoff;
  double cost = 0.0;
  for (Rectangle const& r : cover(refined, per_box, max_nodes)) {
    double nodes = 1.0;
    for (int d = 0; d < 3; ++d) nodes *= transform_length(static_cast<int>(std::ceil((r.high[d] - r.low[d] + 3) * per_box)));
    cost += c.node * nodes;
  }
  for (Box const& box : refined) cost += 0.5 * c.point * stride * (box.sources.size() + box.targets.size());
  return cost;
}

// The cheapest first level for leaves of that capacity.
Plan best_first_level(Sample::Ordered const& points, long capacity, FastParameters const& p, Costs const& c) {
  constexpr int deepest_first = 5;
  OctreeBoxes const tree = points.boxes(capacity);
  double const max_nodes = p.max_nodes(static_cast<std::size_t>(points.n()));
  double const near = c.pair * near_pairs(tree, points.stride, p.single ? 16.0 : 8.0);
  Plan best;
  double deeper = 0.0;  // levels from `first` on
  for (int first = static_cast<int>(tree.refined().size()); first >= 0; --first) {
    if (first < static_cast<int>(tree.refined().size()))
      deeper += level_cost(tree.refined()[first].boxes(), p, c, points.stride, max_nodes);
    double const nodes = root_nodes(points.extent, p, first);
    double const cost = near + deeper + c.node * nodes + c.point * points.n();
    if (first > deepest_first || nodes > max_nodes) continue;
    if (best.cost == 0.0 || cost < best.cost) best = {{capacity, first}, cost};
  }
  return best;
}

// The cheapest octree with these sides of the root, capacities and any first level, unless `best` is cheaper.
Plan cheapest(Sample const& sample, std::vector<double> const& enlargements, std::vector<long> const& capacities,
              FastParameters const& p, Costs const& c, Plan best) {
  std::vector<Sample::Ordered> ordered;
  for (double enlargement : enlargements) ordered.push_back(sample.ordered(enlargement));
  std::vector<Plan> plans(enlargements.size() * capacities.size());
  parallel_for("Fast::best_plan", static_cast<long>(plans.size()), [&](long i) {
    std::size_t const i_side = i / capacities.size();
    plans[i] = best_first_level(ordered[i_side], capacities[i % capacities.size()], p, c);
    plans[i].octree.enlargement = enlargements[i_side];
  });
  for (Plan const& plan : plans)
    if (best.cost == 0.0 || (plan.cost > 0.0 && plan.cost < best.cost)) best = plan;
  return best;
}

}  // namespace

Plan best_plan(std::string_view kernel, ConstPoints sources, ConstPoints targets, FastParameters const& p) {
  require_finite(sources, "source");
  require_finite(targets, "target");
  long const n = static_cast<long>(sources.size() + targets.size()) / 2;
  if (sources.empty() || targets.empty() || n <= p.capacity) return {};
  Costs const c = costs(p, n_component(fast_kernel(kernel)));
  // Some of many points are enough to compare. Of few, a box that is refined in one tree only would make a difference.
  long const enough = p.single && !p.sums_in_double ? 5000 : 20000;
  Sample const sample(sources, targets, std::clamp(n / enough, 1L, 16L));
  Plan const coarse = cheapest(sample, {1.0, 1.26, 1.59}, {p.capacity, 2 * p.capacity, 4 * p.capacity}, p, c, {});
  // Half a step to either side.
  double const side = coarse.octree.enlargement;
  long const capacity = coarse.octree.capacity;
  std::vector<double> sides{side, 1.12 * side};
  if (side > 1.0) sides.push_back(side / 1.12);
  return cheapest(sample, sides, {capacity * 5 / 7, capacity, std::min(capacity * 7 / 5, 4 * p.capacity)}, p, c, coarse);
}

}  // namespace asterflow

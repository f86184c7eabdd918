#include "backends/fast_plan.hpp"

#include "backends/fast_cover.hpp"
#include "base/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace asterflow {
namespace {

// Measured on one core with AVX-512 (Zen 4); only ratios matter.
struct Costs {
  double pair, node, point;  // ns per candidate pair, grid node and point of a patch
};

Costs costs(FastParameters const& p, int components) {
  double const terms = 0.9 * p.split_shape - 2.0, width2 = static_cast<double>(p.width) * p.width;
  double const part = 0.4;  // of the 27 neighbouring boxes that a group of targets meets
  return p.single ? Costs{part * 0.025 * (25.0 + 2.0 * terms), 4.0 * components, 4.0 * width2 + 100.0}
                  : Costs{part * 0.05 * (25.0 + 2.0 * terms), 8.0 * components, 8.0 * width2 + 100.0};
}

double near_pairs(Octree const& tree) {
  double pairs = 0.0;
  for (std::size_t level = 0; level < tree.leaves().size(); ++level)
    for (Box const& box : tree.leaves()[level])
      for (int i = 0; i < 27; ++i) {
        int const x = box.place[0] + i % 3 - 1, y = box.place[1] + i / 3 % 3 - 1, z = box.place[2] + i / 9 - 1;
        if (std::min({x, y, z}) < 0) continue;
        Box const* near = Octree::find(tree.leaves()[level], x, y, z);
        if (near) {
          pairs += static_cast<double>(box.targets.size()) * near->sources.size();
        } else if (level < tree.refined().size() && (near = Octree::find(tree.refined()[level], x, y, z))) {
          pairs += static_cast<double>(box.targets.size()) * near->sources.size();
          pairs += static_cast<double>(box.sources.size()) * near->targets.size();
        }
      }
  return pairs;
}

bool is_same(ConstPoints a, ConstPoints b) { return a.data() == b.data() && a.size() == b.size(); }

PointArray thinned(ConstPoints points, long stride) {
  PointArray few;
  for (std::size_t i = 0; i < points.size(); i += static_cast<std::size_t>(stride)) few.push_back(points[i]);
  return few;
}

}  // namespace

double predicted_cost(Octree const& tree, FastParameters const& p, int components, double thinning) {
  Costs const c = costs(p, components);
  double const n = thinning * static_cast<double>(tree.sources().size() + tree.targets().size());
  double const max_nodes = p.max_nodes(static_cast<std::size_t>(0.5 * n));
  double cost = c.pair * near_pairs(tree) * thinning * thinning;
  for (int level = tree.first_level(); level < static_cast<int>(tree.refined().size()); ++level) {
    double const per_box = 2.0 * p.nodes_per_cutoff;
    for (Rectangle const& r : cover(tree.refined()[level], per_box, max_nodes)) {
      double nodes = 1.0;
      for (int d = 0; d < 3; ++d) nodes *= (r.high[d] - r.low[d] + 3) * per_box;
      cost += c.node * nodes;
    }
    for (Box const& box : tree.refined()[level]) cost += 0.5 * c.point * thinning * (box.sources.size() + box.targets.size());
  }
  return cost;
}

std::unique_ptr<Octree> best_octree(ConstPoints sources, ConstPoints targets, FastParameters const& p, int components) {
  std::size_t const n = (sources.size() + targets.size()) / 2;
  // The coarsest grid costs a fixed time, every level some per point.
  int const first_level = n > 20000 ? 2 : n > 4000 ? 1 : 0;
  if (p.enlargement > 0.0)
    return std::make_unique<Octree>(sources, targets, OctreeOptions{p.capacity, first_level, p.enlargement});
  // Every `stride`-th point is enough to compare.
  long const stride = 1 + static_cast<long>(n) / 16000;
  PointArray const few_sources = thinned(sources, stride);
  PointArray const few_targets = is_same(sources, targets) ? PointArray{} : thinned(targets, stride);
  ConstPoints const s = few_sources, t = is_same(sources, targets) ? s : ConstPoints(few_targets);
  long const capacity = std::max(4L, p.capacity / stride);
  double best = 1.0, least = 0.0;
  for (double enlargement : {1.0, 1.26, 1.59}) {
    Octree const tree(s, t, OctreeOptions{capacity, first_level, enlargement});
    double const cost = predicted_cost(tree, p, components, static_cast<double>(stride));
    if (least == 0.0 || cost < least) {
      best = enlargement;
      least = cost;
    }
  }
  return std::make_unique<Octree>(sources, targets, OctreeOptions{p.capacity, first_level, best});
}

}  // namespace asterflow

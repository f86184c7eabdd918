#include "backends/fast_plan.hpp"

#include "backends/fast_cover.hpp"
#include "backends/fast_fourier.hpp"
#include "backends/fast_kernel.hpp"
#include "backends/fast_sort.hpp"
#include "backends/finite.hpp"
#include "base/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace asterflow {
namespace {

// Measured on one core with AVX-512 (Zen 4).
struct Costs {
  double pair, node, point;  // ns per pair, grid node and point of a patch
};

// lists_once: pairs serve both directions (fast_near_lists.hpp), so that one direction costs less.
Costs costs(FastParameters const& p, int components, bool lists_once) {
  double const digits = (p.split_shape - 2.9) / 2.42, width2 = static_cast<double>(p.width) * p.width;
  double const pair = p.single ? 0.48 + 0.067 * digits : 0.95 + 0.072 * digits;
  double const point = p.single ? (components / 6.0 + 0.5) * (4.0 * width2 + 100.0) : (2.4 * components + 6.8) * width2;
  double const direction = !lists_once ? 1.0 : p.single ? 0.72 : 0.65, normals = components > 3 ? 1.3 : 1.0;
  return {direction * normals * pair, (p.single ? 1.5 : 3.2) * (components + 3), point};
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

    OctreeBoxes boxes(long capacity, int first_level) const {
      OctreeOptions const options{std::max(4L, capacity / static_cast<long>(stride)), first_level};
      return {source_keys, same ? source_keys : target_keys, options};
    }
    double n() const { return 0.5 * stride * static_cast<double>(source_keys.size() + (same ? source_keys : target_keys).size()); }
  };
  // On this thread alone.
  Ordered ordered(double enlargement) const {
    RootCube const cube(sources_, same_ ? sources_ : targets_, enlargement);
    return {cube.extent, keys(sources_, cube), keys(targets_, cube), same_, static_cast<double>(stride_)};
  }

 private:
  static std::vector<std::uint64_t> keys(PointArray const& points, RootCube const& cube) {
    std::vector<KeyedIndex> items;
    items.reserve(points.size());
    for (Vec3d const& x : points) items.push_back({finest_key(cube, x), 0});
    sort_on_this_thread(items);
    std::vector<std::uint64_t> keys;
    keys.reserve(items.size());
    for (KeyedIndex const& item : items) keys.push_back(item.key);
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
  std::vector<double> parts;  // of the leaves of one level
  for (int level = 0; level < static_cast<int>(tree.leaves().size()); ++level) {
    auto const& leaves = tree.leaves()[level].boxes();
    parts.clear();
    for (Box const& box : leaves) parts.push_back(part_within_cutoff(stride * static_cast<double>(box.targets.size()), lanes));
    for (Box const& box : leaves) {
      double const n_source = static_cast<double>(box.sources.size()), n_target = static_cast<double>(box.targets.size());
      double const part = parts[&box - leaves.data()];
      pairs += part * n_target * n_source;
      for (std::uint64_t key : neighbour_keys(box.place, level)) {
        if (key == box.key || key == no_key) continue;
        if (Box const* near = key > box.key ? tree.leaf(level, key) : nullptr) {
          pairs += part * n_target * static_cast<double>(near->sources.size());
          pairs += parts[near - leaves.data()] * n_source * static_cast<double>(near->targets.size());
        } else if ((near = tree.refined_box(level, key))) {
          pairs += part * n_target * static_cast<double>(near->sources.size());
          pairs += part * n_source * static_cast<double>(near->targets.size());
        }
      }
    }
  }
  return pairs * stride * stride;
}

// A grid of transforms, and the parts of its rows y and planes z that sources and targets reach.
struct Grid {
  double nodes = 1.0, sources_y = 1.0, sources_z = 1.0, targets_y = 1.0, targets_z = 1.0;

  // Of the sweeps along x, z, y, z, x, only what is not skipped; fitted.
  double swept() const {
    return nodes * (0.26 * sources_y * sources_z + 0.15 * sources_y + 0.2 + 0.15 * targets_y + 0.24 * targets_y * targets_z);
  }
  // Those that take memory.
  double kept() const { return nodes * std::max(sources_y, targets_y); }
};

// The grid in free space whose cutoff is the side of a box of `level`.
Grid root_grid(Vec3d extent, FastParameters const& p, int level) {
  double const cutoff = std::ldexp(1.0, -level), reach = norm(extent) + cutoff;
  Grid grid;
  double part[3];
  for (int d = 0; d < 3; ++d) {
    double const nodes = transform_length(static_cast<int>(std::ceil((extent[d] + reach + cutoff) * p.nodes_per_cutoff / cutoff + p.width + 2.0)));
    grid.nodes *= nodes;
    part[d] = (extent[d] * p.nodes_per_cutoff / cutoff + p.width + 1.0) / nodes;
  }
  grid.sources_y = grid.targets_y = part[1];
  grid.sources_z = grid.targets_z = part[2];
  return grid;
}

// That of a rectangle of refined boxes; low, high: of all of them on its level.
Grid patch_grid(Rectangle const& r, FastParameters const& p, int const (&low)[3], int const (&high)[3]) {
  double const per_box = 2.0 * p.nodes_per_cutoff;
  Grid grid;
  double targets[3], sources[3];
  for (int d = 0; d < 3; ++d) {
    int const boxes = r.high[d] - r.low[d] + 1;
    double const nodes = transform_length(static_cast<int>(std::ceil((boxes + 2) * per_box)));
    grid.nodes *= nodes;
    targets[d] = std::min(1.0, (boxes * per_box + p.width) / nodes);
    sources[d] = low[d] < r.low[d] || high[d] > r.high[d] ? 1.0 : targets[d];
  }
  grid.sources_y = sources[1], grid.sources_z = sources[2], grid.targets_y = targets[1], grid.targets_z = targets[2];
  return grid;
}

// Of the patches of one level.
double level_cost(std::vector<Box> const& refined, FastParameters const& p, Costs const& c, double stride, double max_nodes) {
  double cost = 0.0;
  int low[3], high[3];
  for (int d = 0; d < 3; ++d) {
    auto const less = [d](Box const& a, Box const& b) { return a.place[d] < b.place[d]; };
    auto const [first, last] = std::minmax_element(refined.begin(), refined.end(), less);
    low[d] = first->place[d], high[d] = last->place[d];
  }
  for (Rectangle const& r : cover(refined, 2.0 * p.nodes_per_cutoff, max_nodes)) cost += c.node * patch_grid(r, p, low, high).swept();
  for (Box const& box : refined) cost += 0.5 * c.point * stride * (box.sources.size() + box.targets.size());
  return cost;
}

// Whether a box above that level is a leaf: another first level would refine it.
bool has_leaf_above(OctreeBoxes const& tree, int level) {
  for (int l = 0; l < level; ++l)
    if (!tree.leaves()[l].boxes().empty()) return true;
  return false;
}

// The cheapest first level for leaves of that capacity; without cost where all cost more than `bound`.
Plan best_first_level(Sample::Ordered const& points, long capacity, FastParameters const& p, Costs const& c, double bound) {
  constexpr int deepest_first = 5;
  OctreeBoxes const tree = points.boxes(capacity, 0);
  double const max_nodes = p.max_nodes(static_cast<std::size_t>(points.n()));
  auto const near = [&](OctreeBoxes const& boxes) { return c.pair * near_pairs(boxes, points.stride, p.single ? 16.0 : 8.0); };
  auto const level = [&](OctreeBoxes const& boxes, int l) {
    return level_cost(boxes.refined()[l].boxes(), p, c, points.stride, max_nodes);
  };
  int const n_level = static_cast<int>(tree.refined().size());
  std::vector<double> deeper(n_level + 1, 0.0);  // levels from each on
  for (int l = n_level - 1; l >= 0; --l) deeper[l] = deeper[l + 1] + level(tree, l);
  double near_of_tree = -1.0;
  Plan best;
  for (int first = 0; first <= std::min(n_level, deepest_first); ++first) {
    Grid const root = root_grid(points.extent, p, first);
    double cost = c.node * root.swept() + c.point * points.n();
    if (root.kept() > 2.0 * max_nodes || cost >= bound) continue;
    if (has_leaf_above(tree, first)) {
      OctreeBoxes const refined = points.boxes(capacity, first);
      for (int l = first; l < static_cast<int>(refined.refined().size()); ++l) cost += level(refined, l);
      if (cost < bound) cost += near(refined);
    } else {
      cost += deeper[first];
      if (cost < bound && near_of_tree < 0.0) near_of_tree = near(tree);
      cost += near_of_tree;
    }
    if (cost >= bound) continue;
    best = {{capacity, first}, cost};
    bound = cost;
  }
  return best;
}

// Compares octrees of given sides of the root and capacities, with any first level; none twice.
class Search {
 public:
  Search(Sample const& sample, FastParameters const& p, Costs const& c) : sample_(sample), p_(p), c_(c) {}

  void compare(std::vector<double> const& enlargements, std::vector<long> const& capacities) {
    order(enlargements);
    std::vector<Plan> plans;
    for (double enlargement : enlargements)
      for (long capacity : capacities)
        if (compared_.emplace(enlargement, capacity).second) plans.push_back({{capacity, 0, enlargement}, 0.0});
    double const bound = best_.cost > 0.0 ? best_.cost : std::numeric_limits<double>::infinity();
    parallel_for("Fast::best_plan", static_cast<long>(plans.size()), [&](long i) {
      double const enlargement = plans[i].octree.enlargement;
      plans[i] = best_first_level(ordered_.at(enlargement), plans[i].octree.capacity, p_, c_, bound);
      plans[i].octree.enlargement = enlargement;
    });
    for (Plan const& plan : plans)
      if (plan.cost > 0.0 && (best_.cost == 0.0 || plan.cost < best_.cost)) best_ = plan;
  }
  Plan const& best() const { return best_; }

 private:
  // Sorts the sample in cubes of these sizes.
  void order(std::vector<double> const& enlargements) {
    std::vector<double> missing;
    for (double enlargement : enlargements)
      if (!ordered_.contains(enlargement)) missing.push_back(enlargement);
    std::vector<Sample::Ordered> ordered(missing.size());
    parallel_for("Fast::order_sample", static_cast<long>(missing.size()), [&](long i) { ordered[i] = sample_.ordered(missing[i]); });
    for (std::size_t i = 0; i < missing.size(); ++i) ordered_.emplace(missing[i], std::move(ordered[i]));
  }

  Sample const& sample_;
  FastParameters const& p_;
  Costs c_;
  std::map<double, Sample::Ordered> ordered_;
  std::set<std::pair<double, long>> compared_;
  Plan best_;
};

}  // namespace

Plan best_plan(std::string_view kernel, ConstPoints sources, ConstPoints targets, FastParameters const& p) {
  require_finite(sources, "source", largest_place);
  require_finite(targets, "target", largest_place);
  long const n = static_cast<long>(sources.size() + targets.size()) / 2;
  if (sources.empty() || targets.empty() || n <= p.capacity) return {};
  Costs const c = costs(p, n_component(fast_kernel(kernel)), is_same(sources, targets) && !p.gradient);
  constexpr long enough = 2500;  // of many points, to compare octrees
  Sample const sample(sources, targets, std::clamp(n / enough, 1L, 16L));
  Search search(sample, p, c);
  search.compare({1.26}, {2 * p.capacity});  // most others cost more, which shows before all of their cost is known
  search.compare({1.0, 1.26, 1.59}, {p.capacity, 2 * p.capacity, 4 * p.capacity});
  // Half a step to either side.
  double const side = search.best().octree.enlargement;
  long const capacity = search.best().octree.capacity;
  std::vector<double> sides{side, 1.12 * side};
  if (side > 1.0) sides.push_back(side / 1.12);
  search.compare(sides, {capacity * 5 / 7, capacity, capacity * 7 / 5});
  return search.best();
}

}  // namespace asterflow

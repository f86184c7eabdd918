#include "backends/fast_plan.hpp"

#include "backends/fast_cover.hpp"
#include "backends/fast_fourier.hpp"
#include "backends/fast_kernel.hpp"
#include "backends/fast_nested.hpp"
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
  double const pair = p.single ? 0.48 + 0.067 * digits : p.gradient ? 0.95 + 0.072 * digits : 0.50 + 0.085 * digits;
  double const point = p.single ? (components / 6.0 + 0.5) * (4.0 * width2 + 100.0) : (1.1 * components + 6.8) * width2;
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
    double largest_distance;
    std::vector<std::uint64_t> source_keys, target_keys;
    bool same;
    double stride;

    long in_sample(long capacity) const { return std::max(4L, capacity / static_cast<long>(stride)); }
    NestedOctrees octrees(long smallest_capacity, int first_level) const {
      return {source_keys, same ? source_keys : target_keys, {in_sample(smallest_capacity), first_level}};
    }
    double n() const { return 0.5 * stride * static_cast<double>(source_keys.size() + (same ? source_keys : target_keys).size()); }
  };
  // On this thread alone.
  Ordered ordered(double enlargement) const {
    RootCube const cube(sources_, same_ ? sources_ : targets_, enlargement);
    return {cube.extent, cube.largest_distance, keys(sources_, cube), keys(targets_, cube), same_, static_cast<double>(stride_)};
  }

 private:
  static std::vector<std::uint64_t> keys(PointArray const& points, RootCube const& cube) {
    std::vector<KeyedIndex> items(points.size());
    find_keys(points, 0, static_cast<long>(points.size()), cube, items.data());
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

// Pairs in the lists of one of the octrees of a sample; where they are more than `most`, any number above it. part: of the 27 boxes
// around a leaf with so many targets of the sample, what a group of them has within the cutoff.
template <class Part>
double near_pairs(NestedOctrees const& octrees, OctreeChoice const& octree, Part const& part, double most) {
  double pairs = 0.0;
  for (int l = 0; l < static_cast<int>(octrees.levels().size()) && pairs <= most; ++l) {
    auto const& level = octrees.levels()[l];
    for (std::size_t i = 0; i < level.boxes.size(); ++i) {
      if (!octrees.exists(level, l, i, octree) || octrees.is_refined(level, l, i, octree)) continue;
      Box const& leaf = level.boxes[i];
      long n_source = 0, n_target = 0;  // around the leaf; in refined boxes, whose lists hold the leaf's sources
      for (std::int32_t near : level.around[i]) {
        if (near < 0 || !octrees.exists(level, l, near, octree)) continue;
        n_source += level.boxes[near].sources.size();
        if (octrees.is_refined(level, l, near, octree)) n_target += level.boxes[near].targets.size();
      }
      double const n = static_cast<double>(leaf.targets.size() * n_source + leaf.sources.size() * n_target);
      pairs += part(leaf.targets.size()) * n;
    }
  }
  return pairs;
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
Grid root_grid(Vec3d extent, double largest_distance, FastParameters const& p, int level) {
  double const cutoff = std::ldexp(1.0, -level), reach = largest_distance + cutoff;
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
  constexpr double to_images = 0.8;  // boxes, less what those at the edges have empty
  Grid grid;
  double targets[3], sources[3];
  for (int d = 0; d < 3; ++d) {
    int const boxes = r.high[d] - r.low[d] + 1;
    bool const has_neighbours = low[d] < r.low[d] || high[d] > r.high[d];
    double const nodes = transform_length(static_cast<int>(std::ceil((boxes + (has_neighbours ? 2.0 : to_images)) * per_box)));
    grid.nodes *= nodes;
    targets[d] = std::min(1.0, (boxes * per_box + p.width) / nodes);
    sources[d] = has_neighbours ? 1.0 : targets[d];
  }
  grid.sources_y = sources[1], grid.sources_z = sources[2], grid.targets_y = targets[1], grid.targets_z = targets[2];
  return grid;
}

// Of the patches of one level.
double level_cost(std::vector<Box const*> const& refined, FastParameters const& p, Costs const& c, double stride, double max_nodes) {
  double cost = 0.0;
  int low[3], high[3];
  for (int d = 0; d < 3; ++d) {
    auto const less = [d](Box const* a, Box const* b) { return a->place[d] < b->place[d]; };
    auto const [first, last] = std::minmax_element(refined.begin(), refined.end(), less);
    low[d] = (*first)->place[d], high[d] = (*last)->place[d];
  }
  for (Rectangle const& r : cover(refined, 2.0 * p.nodes_per_cutoff, max_nodes)) cost += c.node * patch_grid(r, p, low, high).swept();
  for (Box const* box : refined) cost += 0.5 * c.point * stride * static_cast<double>(box->sources.size() + box->targets.size());
  return cost;
}

// Compares octrees of one side of the root.
class SideSearch {
 public:
  SideSearch(Sample::Ordered const& points, FastParameters const& p, Costs const& c)
      : points_(points), p_(p), c_(c), max_nodes_(p.max_nodes(static_cast<std::size_t>(points.n()))) {
    double const lanes = p.single ? 16.0 : 8.0;
    for (long n = 0; n < 256; ++n) parts_.push_back(part_within_cutoff(points.stride * static_cast<double>(n), lanes));
  }

  // The cheapest with leaves of these capacities and any first level; without cost where all cost `bound` or more.
  Plan best(std::vector<long> const& capacities, double bound) {
    best_ = {{}, bound};
    long const smallest = *std::min_element(capacities.begin(), capacities.end());
    refine(smallest, 0);
    std::vector<int> beyond;  // of each capacity, the first level that the largest leaf is above
    for (long capacity : capacities) {
      beyond.push_back(std::min(octrees_.level_of_largest_leaf(points_.in_sample(capacity)), deepest_first) + 1);
      for (int first = 0; first < beyond.back(); ++first) compare(capacity, first);
    }
    int deepest = 0;
    for (int first : beyond)
      while (first <= std::min(octrees_.n_refined_level(), deepest_first) && root_cost(first) < best_.cost) deepest = std::max(deepest, first++);
    if (deepest > 0) refine(smallest, deepest);
    for (std::size_t i = 0; i < capacities.size(); ++i)
      for (int first = beyond[i]; first <= deepest; ++first) compare(capacities[i], first);
    return best_.cost < bound ? best_ : Plan{};
  }

 private:
  static constexpr int deepest_first = 5;

  void refine(long smallest_capacity, int first_level) {
    octrees_ = points_.octrees(smallest_capacity, first_level);
    leaves_above_ = first_level > 0;
    level_costs_.assign(octrees_.levels().size(), {});
    near_costs_.clear();
  }

  double root_cost(int first_level) const {
    Grid const root = root_grid(points_.extent, points_.largest_distance, p_, first_level);
    if (root.kept() > 2.0 * max_nodes_) return std::numeric_limits<double>::infinity();
    return c_.node * root.swept() + c_.point * points_.n();
  }

  void compare(long capacity, int first_level) {
    OctreeChoice const octree{points_.in_sample(capacity), first_level};
    double cost = root_cost(first_level);
    std::size_t n_refined = 0;
    for (int l = 0; l < static_cast<int>(octrees_.levels().size()) && cost < best_.cost; ++l) {
      auto const refined = octrees_.refined(l, octree);
      n_refined += refined.size();
      if (l >= first_level && !refined.empty()) cost += level_cost_of(l, refined);
    }
    if (cost < best_.cost) cost += near_cost(octree, n_refined, best_.cost - cost);
    if (cost < best_.cost) best_ = {{capacity, first_level}, cost};
  }

  // Of two octrees as many refined boxes of a level are the same ones.
  double level_cost_of(int level, std::vector<Box const*> const& refined) {
    double& cost = level_costs_[level].try_emplace(refined.size(), -1.0).first->second;
    if (cost < 0.0) cost = level_cost(refined, p_, c_, points_.stride, max_nodes_);
    return cost;
  }
  // At least that: no more is found out than that it is above `most`. As many refined boxes of all levels are the same ones where
  // no leaf is refined for the sake of the first level.
  double near_cost(OctreeChoice const& octree, std::size_t n_refined, double most) {
    double& cost = near_costs_[{leaves_above_ ? octree.first_level : 0, n_refined}];
    double const unit = c_.pair * points_.stride * points_.stride;
    auto const part = [&](long n) {
      return n < static_cast<long>(parts_.size()) ? parts_[n] : part_within_cutoff(points_.stride * static_cast<double>(n), p_.single ? 16.0 : 8.0);
    };
    if (cost < most) cost = unit * near_pairs(octrees_, octree, part, most / unit);
    return cost;
  }

  Sample::Ordered const& points_;
  FastParameters const& p_;
  Costs c_;
  double max_nodes_;
  std::vector<double> parts_;
  NestedOctrees octrees_;
  bool leaves_above_ = false;  // first levels below leaves are compared
  std::vector<std::map<std::size_t, double>> level_costs_;
  std::map<std::pair<int, std::size_t>, double> near_costs_;  // by first level, number of refined boxes
  Plan best_;
};

// Compares octrees of given sides of the root and capacities, with any first level; none twice.
class Search {
 public:
  Search(Sample const& sample, FastParameters const& p, Costs const& c) : sample_(sample), p_(p), c_(c) {}

  void compare(std::vector<double> const& enlargements, std::vector<long> const& capacities) {
    order(enlargements);
    std::vector<std::pair<double, std::vector<long>>> sides;
    for (double enlargement : enlargements) {
      std::vector<long> fresh;
      for (long capacity : capacities)
        if (compared_.emplace(enlargement, capacity).second) fresh.push_back(capacity);
      if (!fresh.empty()) sides.emplace_back(enlargement, fresh);
    }
    double const bound = best_.cost > 0.0 ? best_.cost : std::numeric_limits<double>::infinity();
    std::vector<Plan> plans(sides.size());
    parallel_for("Fast::best_plan", static_cast<long>(sides.size()), [&](long i) {
      plans[i] = SideSearch(ordered_.at(sides[i].first), p_, c_).best(sides[i].second, bound);
      plans[i].octree.enlargement = sides[i].first;
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

bool is_direct(std::size_t n_source, std::size_t n_target, FastParameters const& p) {
  return static_cast<long>(std::min(n_source, n_target)) <= p.capacity;
}

Plan best_plan(std::string_view kernel, ConstPoints sources, ConstPoints targets, FastParameters const& p) {
  require_finite(sources, "source", largest_place);
  require_finite(targets, "target", largest_place);
  long const n = static_cast<long>(sources.size() + targets.size()) / 2;
  if (is_direct(sources.size(), targets.size(), p)) return {};
  Costs const c = costs(p, n_component(fast_kernel(kernel)), is_same(sources, targets) && !p.gradient);
  constexpr long enough = 2500;  // of many points, to compare octrees
  Sample const sample(sources, targets, std::clamp(n / enough, 1L, 16L));
  Search search(sample, p, c);
  std::vector<long> const capacities{2 * p.capacity, p.capacity, 4 * p.capacity};
  search.compare({1.26}, capacities);  // most others cost more, which shows before all of their cost is known
  search.compare({1.0, 1.59}, capacities);
  // Half a step to either side.
  double const side = search.best().octree.enlargement;
  long const capacity = search.best().octree.capacity;
  std::vector<double> sides{side, 1.12 * side};
  if (side > 1.0) sides.push_back(side / 1.12);
  search.compare(sides, {capacity * 5 / 7, capacity, capacity * 7 / 5});
  return search.best();
}

}  // namespace asterflow

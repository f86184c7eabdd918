#include "backends/fast_near_lists.hpp"

#include "backends/blocks.hpp"
#include "base/error.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace asterflow {
namespace {

// Below this distance the two-part float coordinates are not accurate enough.
constexpr double close_distance = 1e-8;

constexpr long list_span = 65536;  // sources one segment of a list can point to

// Splits positions [first, last) at a multiple of `unit` near the middle of their longest extent until
// every piece has at most `unit` points.
void make_compact(PointArray const& points, std::uint32_t* first, std::uint32_t* last, long unit) {
  long const n = last - first;
  if (n <= unit) return;
  Vec3d low = points[*first], high = low;
  for (auto* i = first; i < last; ++i)
    for (int d = 0; d < 3; ++d) {
      low[d] = std::min(low[d], points[*i][d]);
      high[d] = std::max(high[d], points[*i][d]);
    }
  Vec3d const e = high - low;
  int const d = e.x >= e.y && e.x >= e.z ? 0 : e.y >= e.z ? 1 : 2;
  auto* const middle = first + ((n + unit - 1) / unit + 1) / 2 * unit;
  std::nth_element(first, middle, last, [&](std::uint32_t a, std::uint32_t b) {
    return points[a][d] != points[b][d] ? points[a][d] < points[b][d] : a < b;
  });
  make_compact(points, first, middle, unit);
  make_compact(points, middle, last, unit);
}

}  // namespace

void NearLists::set_points(Octree& tree) {
  tree_ = &tree;
  auto const& leaves = tree.boxes().leaves();
  std::vector<std::pair<int, Box const*>> boxes;
  for (std::size_t level = 0; level < leaves.size(); ++level)
    for (Box const& box : leaves[level].boxes())
      if (box.targets.size() > 0) boxes.emplace_back(static_cast<int>(level), &box);
  leaves_.assign(boxes.size(), {});
  parallel_for("NearLists::set_points::order", static_cast<long>(boxes.size()), [&](long i) {
    Range const range = boxes[i].second->targets;
    std::vector<std::uint32_t> order(range.size());
    std::iota(order.begin(), order.end(), static_cast<std::uint32_t>(range.begin));
    make_compact(tree.targets(), order.data(), order.data() + order.size(), group_size_);
    tree.reorder_targets(range, order);
  });
  for (auto& coordinates : filter_) coordinates.assign(sources().size() + NearQuery::max_target, 0.0f);
  for_blocks("NearLists::set_points::filter", static_cast<long>(sources().size()), [&](long i) {
    Vec3d const x = tree.normalised(sources()[i]);
    for (int d = 0; d < 3; ++d) filter_[d][i] = static_cast<float>(x[d]);
  });
  parallel_for("NearLists::set_points::list", static_cast<long>(boxes.size()),
               [&](long i) { leaves_[i] = list_sources(boxes[i].first, *boxes[i].second); });
  for (auto& coordinates : filter_) coordinates = {};
}

bool NearLists::is_close(long target, int n_target, std::uint32_t source) const {
  for (long t = target; t < target + n_target; ++t) {
    Vec3d const r = targets()[t] - sources()[source];
    double const r2 = dot(r, r);
    if (r2 > 0.0 && r2 < close_distance * close_distance) return true;
  }
  return false;
}

// Boxes of the target's own level hold only sources as fine or finer; coarser leaves are found around the
// target's ancestors. By level and place, so that segments of lists can be joined.
std::vector<NearLists::Candidates> NearLists::candidates(int level, Box const& box) const {
  std::vector<Candidates> found;
  for (int l = level; l >= 0; --l) {
    if (tree_->boxes().leaves()[l].boxes().empty()) continue;
    int const shift = level - l;
    std::size_t const first = found.size();
    int const place[3] = {box.place[0] >> shift, box.place[1] >> shift, box.place[2] >> shift};
    for (std::uint64_t key : neighbour_keys(place, l)) {
      Box const* near = tree_->boxes().leaf(l, key);
      if (!near && l == level) near = tree_->boxes().refined_box(l, key);
      if (!near) continue;
      for (long begin = near->sources.begin; begin < near->sources.end; begin += list_span)
        found.push_back({l, {begin, std::min(near->sources.end, begin + list_span)}});
    }
    std::sort(found.begin() + static_cast<long>(first), found.end(),
              [](Candidates const& a, Candidates const& b) { return a.sources.begin < b.sources.begin; });
  }
  return found;
}

NearQuery NearLists::query(long first, int n) const {
  NearQuery q;
  q.n_target = n;
  for (int i = 0; i < n; ++i) {
    Vec3d const x = tree_->normalised(targets()[first + i]);
    for (int d = 0; d < 3; ++d) {
      q.targets[d][i] = static_cast<float>(x[d]);
      q.low[d] = i == 0 ? q.targets[d][i] : std::min(q.low[d], q.targets[d][i]);
      q.high[d] = i == 0 ? q.targets[d][i] : std::max(q.high[d], q.targets[d][i]);
    }
  }
  for (int d = 0; d < 3; ++d) q.sources[d] = filter_[d].data();
  return q;
}

void NearLists::append_near(NearQuery const& query, NearGroup const& group, Candidates const& from,
                                  std::size_t first_segment, Leaf& leaf) const {
  bool const joins = leaf.segments.size() > first_segment && leaf.segments.back().level == from.level &&
                     from.sources.end - leaf.segments.back().base <= list_span;
  long const base = joins ? leaf.segments.back().base : from.sources.begin;
  static thread_local std::vector<std::uint16_t> space[2];
  std::size_t const most = static_cast<std::size_t>(from.sources.size()) + NearQuery::max_target;
  for (auto& numbers : space) numbers.resize(std::max(numbers.size(), most));
  NearFound found{space[0].data(), space[1].data()};
  find_(query, from.sources.begin, from.sources.end, base, found);
  if (sets_close_apart_) set_close_apart(group, from.level, static_cast<std::uint32_t>(base), found, leaf);
  if (found.n_source == 0) return;
  leaf.list.insert(leaf.list.end(), found.sources, found.sources + found.n_source);
  auto const end = static_cast<std::uint32_t>(leaf.list.size());
  if (joins)
    leaf.segments.back().end = end;
  else
    leaf.segments.push_back({static_cast<std::uint32_t>(base), end, from.level});
}

// Moves the sources that nearly touch a target from those found to leaf.close.
void NearLists::set_close_apart(NearGroup const& group, int level, std::uint32_t base, NearFound& found, Leaf& leaf) const {
  long n_moved = 0;
  for (long k = 0; k < found.n_touching; ++k) {
    long const place = found.touching[k] - n_moved;
    std::uint32_t const source = base + found.sources[place];
    if (!is_close(group.target, group.n_target, source)) continue;
    leaf.close.push_back(source);
    std::copy(found.sources + place + 1, found.sources + found.n_source, found.sources + place);
    --found.n_source;
    ++n_moved;
  }
  leaf.close_levels.resize(leaf.close.size(), level);
}

NearLists::Leaf NearLists::list_sources(int level, Box const& box) const {
  constexpr double slack = 4e-7;  // rounding of normalised float coordinates
  auto const near = candidates(level, box);
  Leaf leaf;
  for (long t = box.targets.begin; t < box.targets.end; t += group_size_) {
    NearGroup group{t, static_cast<int>(std::min<long>(group_size_, box.targets.end - t)), 0, 0};
    NearQuery q = query(t, group.n_target);
    std::size_t const first_segment = leaf.segments.size();
    for (auto const& from : near) {
      q.reach = static_cast<float>(std::ldexp(1.0, -from.level) + slack);
      append_near(q, group, from, first_segment, leaf);
    }
    group.segment_end = static_cast<std::uint32_t>(leaf.segments.size());
    group.close_end = static_cast<std::uint32_t>(leaf.close.size());
    leaf.groups.push_back(group);
  }
  ASTERFLOW_REQUIRE(leaf.list.size() < 0xffffffffu);
  leaf.list.shrink_to_fit();
  leaf.segments.shrink_to_fit();
  leaf.groups.shrink_to_fit();
  return leaf;
}

std::size_t NearLists::memory() const {
  std::size_t bytes = leaves_.capacity() * sizeof(Leaf);
  for (Leaf const& leaf : leaves_)
    bytes += leaf.groups.capacity() * sizeof(NearGroup) + leaf.segments.capacity() * sizeof(NearSegment) +
             leaf.list.capacity() * sizeof(std::uint16_t) + leaf.close.capacity() * 2 * sizeof(std::uint32_t);
  return bytes;
}

}  // namespace asterflow

#include "backends/fast_near_lists.hpp"

#include "backends/blocks.hpp"
#include "base/error.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <tuple>
#include <utility>

namespace asterflow {
namespace {

// Below this distance the two-part float coordinates are not accurate enough, and fifth powers of 1 / r overflow in float.
constexpr double close_distance = 1e-7;

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
  long const middle = ((n + unit - 1) / unit + 1) / 2 * unit;
  static thread_local std::vector<std::pair<double, std::uint32_t>> along;
  along.clear();
  for (auto* i = first; i < last; ++i) along.emplace_back(points[*i][d], *i);
  std::nth_element(along.begin(), along.begin() + middle, along.end());
  std::transform(along.begin(), along.end(), first, [](auto const& item) { return item.second; });
  make_compact(points, first, first + middle, unit);
  make_compact(points, first + middle, last, unit);
}

}  // namespace

// Leaves in the order of their points.
void NearLists::set_points(Octree& tree, bool lists_once) {
  tree_ = &tree;
  lists_once_ = lists_once && tree.is_self();
  auto const& leaves = tree.boxes().leaves();
  std::vector<std::pair<int, Box const*>> boxes;
  for (std::size_t level = 0; level < leaves.size(); ++level)
    for (Box const& box : leaves[level].boxes())
      if (box.targets.size() > 0) boxes.emplace_back(static_cast<int>(level), &box);
  std::sort(boxes.begin(), boxes.end(), [](auto const& a, auto const& b) { return a.second->targets.begin < b.second->targets.begin; });
  leaves_.assign(boxes.size(), {});
  leaf_of_box_.clear();
  for (BoxLevel const& level : leaves) leaf_of_box_.emplace_back(level.boxes().size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    auto const [level, box] = boxes[i];
    leaf_of_box_[level][box - leaves[level].boxes().data()] = static_cast<std::uint32_t>(i);
  }
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
  if (lists_once_) mirror_close_pairs();
  gather_reactions();
}

// Close pairs of two groups act in the other direction too.
void NearLists::mirror_close_pairs() {
  std::vector<ClosePair> mirrored;
  for (Leaf const& leaf : leaves_) {
    auto const group_of = [&](long point) { return (point - leaf.targets.begin) / group_size_; };
    for (ClosePair const& pair : leaf.close) {
      bool const is_own = pair.source >= leaf.targets.begin && pair.source < leaf.targets.end;
      if (!is_own || group_of(pair.source) != group_of(pair.target)) mirrored.push_back({pair.source, pair.target, pair.level});
    }
  }
  for (ClosePair const& pair : mirrored) {
    auto const is_after = [](long target, Leaf const& leaf) { return target < leaf.targets.begin; };
    auto const next = std::upper_bound(leaves_.begin(), leaves_.end(), static_cast<long>(pair.target), is_after);
    std::prev(next)->close.push_back(pair);
  }
}

// Sorts the reactions to every leaf's targets by the leaf that they act on.
void NearLists::gather_reactions() {
  first_reactions_.assign(leaves_.size() + 1, 0);
  for (Leaf const& leaf : leaves_)
    for (Reactions const& r : leaf.reactions) ++first_reactions_[r.leaf + 1];
  std::partial_sum(first_reactions_.begin(), first_reactions_.end(), first_reactions_.begin());
  reactions_.resize(first_reactions_.back());
  std::vector<long> next(first_reactions_.begin(), first_reactions_.end() - 1);
  long place = 0;
  for (Leaf& leaf : leaves_) {
    leaf.first_place = std::exchange(place, place + leaf.n_place);
    for (Reactions const& r : leaf.reactions) reactions_[next[r.leaf]++] = {r.sources, leaf.first_place + r.place, r.leaf};
    leaf.reactions = {};
  }
}

bool NearLists::is_close(long target, int n_target, std::uint32_t source) const {
  Vec3d const from = sources()[source];
  Vec3d const* const at = targets().data();
  for (long t = target; t < target + n_target; ++t) {
    if (std::abs(at[t].x - from.x) >= close_distance) continue;
    double const r2 = dot(at[t] - from, at[t] - from);
    if (r2 > 0.0 && r2 < close_distance * close_distance) return true;
  }
  return false;
}

// Boxes of the target's own level hold only sources as fine or finer; coarser leaves are found around the
// target's ancestors. By level and place, so that segments of lists can be joined. Of two leaves whose pairs are listed
// once the finer lists them or, of one level, the first; the leaf itself is left out then.
std::vector<NearLists::Candidates> NearLists::candidates(int level, Box const& box) const {
  std::vector<Candidates> found;
  std::vector<Reactions> near_boxes;  // of one level
  for (int l = level; l >= 0; --l) {
    if (tree_->boxes().leaves()[l].boxes().empty()) continue;
    int const shift = level - l;
    near_boxes.clear();
    for (std::uint64_t key : neighbour_keys(box.key >> 3 * shift, l)) {
      if (lists_once_ && l == level && key <= box.key) continue;
      Box const* near = tree_->boxes().leaf(l, key);
      if (!near && l == level && !lists_once_) near = tree_->boxes().refined_box(l, key);
      if (!near) continue;
      std::uint32_t const leaf = lists_once_ ? leaf_of_box_[l][near - tree_->boxes().leaves()[l].boxes().data()] : 0;
      for (long begin = near->sources.begin; begin < near->sources.end; begin += list_span)
        near_boxes.push_back({{begin, std::min(near->sources.end, begin + list_span)}, 0, leaf});
    }
    std::sort(near_boxes.begin(), near_boxes.end(),
              [](Reactions const& a, Reactions const& b) { return a.sources.begin < b.sources.begin; });
    std::size_t const first = found.size();
    for (Reactions const& near : near_boxes) {
      bool const follows = found.size() > first && found.back().sources.end == near.sources.begin &&
                           near.sources.end - found.back().sources.begin <= list_span;
      if (!follows) found.push_back({l, {near.sources.begin, near.sources.begin}, lists_once_, -1, {}});
      found.back().sources.end = near.sources.end;
      if (lists_once_) found.back().boxes.push_back(near);
    }
  }
  return found;
}

NearQuery NearLists::query(long first, int n) const {
  NearQuery q;
  q.n_target = n;
  for (int i = 0; i < n; ++i) {
    Vec3d const x = tree_->normalised(targets()[first + i]);
    for (int d = 0; d < 3; ++d) q.targets[d][i] = static_cast<float>(x[d]);
    q.squares[i] = 0.0f;
  }
  for (int d = 0; d < 3; ++d) {
    q.sources[d] = filter_[d].data();
    auto const [low, high] = std::minmax_element(q.targets[d], q.targets[d] + n);
    q.middle[d] = 0.5f * (*low + *high);
    q.half[d] = std::max(*high - q.middle[d], q.middle[d] - *low);
    for (int i = 0; i < n; ++i) {
      float const x = q.targets[d][i] - q.middle[d];
      q.targets[d][i] = 2.0f * x;
      q.squares[i] += x * x;
    }
  }
  return q;
}

void NearLists::append_near(NearQuery& query, NearGroup const& group, Candidates& from, Leaf& leaf) const {
  constexpr double slack = 4e-7;  // rounding of normalised float coordinates
  double const cutoff = std::ldexp(1.0, -from.level);
  query.reach = static_cast<float>(cutoff + slack);
  query.inner = inner_reach_ < 1.0 ? static_cast<float>((inner_reach_ + 1e-5) * cutoff + slack) : 2.0f * query.reach;
  bool const joins = !from.is_mutual && leaf.segments.size() > group.segment_end &&
                     leaf.segments.back().reaction == NearSegment::one_way && leaf.segments.back().level == from.level &&
                     from.sources.end - leaf.segments.back().base <= list_span;
  long const base = joins ? leaf.segments.back().base : from.sources.begin;
  static thread_local std::vector<std::uint16_t> space[3];
  std::size_t const most = static_cast<std::size_t>(from.sources.size()) + NearQuery::max_target;
  for (auto& numbers : space) numbers.resize(std::max(numbers.size(), most));
  NearFound found{space[0].data(), space[1].data(), space[2].data()};
  find_(query, from.sources.begin, from.sources.end, base, found);
  if (sets_close_apart_) set_close_apart(group, from.level, static_cast<std::uint32_t>(base), found, leaf);
  if (found.n_source + found.n_outer == 0) return;
  if (from.is_mutual && from.place < 0) {
    from.place = leaf.n_place;
    for (Reactions const& at : from.boxes)
      leaf.reactions.push_back({at.sources, std::exchange(leaf.n_place, leaf.n_place + at.sources.size()), at.leaf});
  }
  NearSegment segment{static_cast<std::uint32_t>(base), 0, from.level,
                      from.is_mutual ? static_cast<std::int32_t>(from.place) : NearSegment::one_way};
  auto const append = [&](std::uint16_t const* sources, long n, std::vector<NearSegment>& segments, std::uint32_t first,
                          std::vector<std::uint16_t>& list) {
    if (n == 0) return;
    list.insert(list.end(), sources, sources + n);
    segment.end = static_cast<std::uint32_t>(list.size());
    bool const follows = segments.size() > first && segments.back().base == segment.base && segments.back().level == segment.level &&
                         segments.back().reaction == segment.reaction;
    if (follows)
      segments.back().end = segment.end;
    else
      segments.push_back(segment);
  };
  append(found.sources, found.n_source, leaf.segments, group.segment_end, leaf.list);
  append(found.outer, found.n_outer, leaf.outer_segments, group.outer_end, leaf.outer_list);
}

// Moves the sources that nearly touch a target from those found to leaf.close.
void NearLists::set_close_apart(NearGroup const& group, int level, std::uint32_t base, NearFound& found, Leaf& leaf) const {
  long n_moved = 0;
  for (long k = 0; k < found.n_touching; ++k) {
    long const place = found.touching[k] - n_moved;
    std::uint32_t const source = base + found.sources[place];
    if (!is_close(group.target, group.n_target, source)) continue;
    for (int t = 0; t < group.n_target; ++t) leaf.close.push_back({static_cast<std::uint32_t>(group.target + t), source, level});
    std::copy(found.sources + place + 1, found.sources + found.n_source, found.sources + place);
    --found.n_source;
    ++n_moved;
  }
}

// Of the leaf itself, pairs listed once: those of the group one way, then those with the groups after it. The places of
// the leaf's own reactions are its first.
void NearLists::append_own(NearQuery& query, NearGroup const& group, int level, Leaf& leaf) const {
  Range const all = leaf.targets;
  long const next = group.target + group.n_target;
  Candidates group_only{level, {group.target, next}, false, -1, {}};
  append_near(query, group, group_only, leaf);
  for (long begin = next; begin < all.end; begin += list_span) {
    Candidates rest{level, {begin, std::min(all.end, begin + list_span)}, true, begin - all.begin, {}};
    append_near(query, group, rest, leaf);
  }
}

NearLists::Leaf NearLists::list_sources(int level, Box const& box) const {
  static thread_local std::vector<std::uint16_t> lists[2];     // grown once for many leaves,
  static thread_local std::vector<NearSegment> segments[2];  // whose own take what they need
  auto near = candidates(level, box);
  Leaf leaf;
  auto const own = [&](int i) { return std::tie(i == 0 ? leaf.list : leaf.outer_list, i == 0 ? leaf.segments : leaf.outer_segments); };
  for (int i = 0; i < 2; ++i) {
    auto [list, segment] = own(i);
    lists[i].clear(), list.swap(lists[i]);
    segments[i].clear(), segment.swap(segments[i]);
  }
  leaf.targets = box.targets;
  leaf.groups.reserve((box.targets.size() + group_size_ - 1) / group_size_);
  if (lists_once_) {
    leaf.reactions.push_back({box.targets, 0, leaf_of_box_[level][&box - tree_->boxes().leaves()[level].boxes().data()]});
    leaf.n_place = box.targets.size();
  }
  for (long t = box.targets.begin; t < box.targets.end; t += group_size_) {
    NearGroup group{t, static_cast<int>(std::min<long>(group_size_, box.targets.end - t)),
                    static_cast<std::uint32_t>(leaf.segments.size()), static_cast<std::uint32_t>(leaf.outer_segments.size())};
    NearQuery q = query(t, group.n_target);
    if (lists_once_) append_own(q, group, level, leaf);
    for (auto& from : near) append_near(q, group, from, leaf);
    group.segment_end = static_cast<std::uint32_t>(leaf.segments.size());
    group.outer_end = static_cast<std::uint32_t>(leaf.outer_segments.size());
    leaf.groups.push_back(group);
  }
  ASTERFLOW_REQUIRE(leaf.list.size() < 0xffffffffu && leaf.outer_list.size() < 0xffffffffu && leaf.n_place < 0x7fffffff);
  for (int i = 0; i < 2; ++i) {
    auto [list, segment] = own(i);
    list.swap(lists[i]), list = lists[i];
    segment.swap(segments[i]), segment = segments[i];
  }
  return leaf;
}

std::size_t NearLists::memory() const {
  std::size_t bytes = leaves_.capacity() * sizeof(Leaf) + reactions_.capacity() * sizeof(Reactions);
  for (Leaf const& leaf : leaves_)
    bytes += leaf.groups.capacity() * sizeof(NearGroup) + leaf.segments.capacity() * sizeof(NearSegment) +
             (leaf.list.capacity() + leaf.outer_list.capacity()) * sizeof(std::uint16_t) +
             leaf.outer_segments.capacity() * sizeof(NearSegment) + leaf.close.capacity() * sizeof(ClosePair);
  return bytes;
}

}  // namespace asterflow

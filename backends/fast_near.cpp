#include "backends/fast_near.hpp"

#include "base/error.hpp"
#include "base/parallel.hpp"

#include <algorithm>
#include <numeric>

namespace asterflow {
namespace {

// Below this distance the two-part float coordinates are not accurate enough.
constexpr double close_distance = 1e-8;

// One pair for a whole vector of targets. a, b: values of the polynomials; inside: 1 / r or 0 where the pair
// does not count; source: strength, then normal.
struct NearStokeslet {
  static constexpr int powers = 1;  // A scales as 1 / cutoff, B as 1 / cutoff^3
  template <class P, class M, class Real>
  static void add(P const (&r)[3], P inverse, P a, P b, M inside, Real const* f, P (&u)[3]) {
    P const zero{};
    P const first = inside ? inverse - a : zero;
    P const second = inside ? inverse * inverse * inverse - b : zero;
    P const along = second * (r[0] * f[0] + r[1] * f[1] + r[2] * f[2]);
    for (int d = 0; d < 3; ++d) u[d] += first * f[d] + along * r[d];
  }
};

struct NearRotlet {
  static constexpr int powers = 1;
  template <class P, class M, class Real>
  static void add(P const (&r)[3], P inverse, P, P b, M inside, Real const* t, P (&u)[3]) {
    P const s = inside ? inverse * inverse * inverse - b : P{};
    u[0] += s * (t[1] * r[2] - t[2] * r[1]);
    u[1] += s * (t[2] * r[0] - t[0] * r[2]);
    u[2] += s * (t[0] * r[1] - t[1] * r[0]);
  }
};

struct NearStresslet {
  static constexpr int powers = 3;  // A scales as 1 / cutoff^3, B as 1 / cutoff^5
  template <class P, class M, class Real>
  static void add(P const (&r)[3], P inverse, P a, P b, M inside, Real const* q, P (&u)[3]) {
    Real const* n = q + 3;
    P const zero{};
    P const first = inside ? -a : zero;
    P const rq = r[0] * q[0] + r[1] * q[1] + r[2] * q[2], rn = r[0] * n[0] + r[1] * n[1] + r[2] * n[2];
    // The fifth power of 1 / r alone would overflow in float.
    P const singular = inverse * inverse * inverse * (rq * inverse) * (rn * inverse);
    P const second = inside ? Real(-6) * (singular - b * rq * rn) : zero;
    P const along = second + first * (q[0] * n[0] + q[1] * n[1] + q[2] * n[2]);
    P const by_q = first * rn, by_n = first * rq;
    for (int d = 0; d < 3; ++d) u[d] += along * r[d] + by_q * q[d] + by_n * n[d];
  }
};

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

template <class Real>
NearField<Real>::NearField(std::string_view kernel, LocalPart const& local, int refinement_steps)
    : kernel_(kernel), local_(local), refinement_steps_(refinement_steps) {
  int const terms = static_cast<int>(local_.a.size() + 3) / 4 * 4;
  ASTERFLOW_REQUIRE(terms <= (sizeof(Real) == 4 ? 12 : 32));
  local_.a.resize(terms, 0.0);
  local_.b.resize(terms, 0.0);
  record_ = (split_coordinates ? 6 : 3) + (kernel == "stresslet" ? 6 : 3);
}

template <class Real>
void NearField<Real>::make_levels(int n_level) {
  levels_.clear();
  int const power = kernel_ == "stresslet" ? NearStresslet::powers : NearStokeslet::powers;
  for (int level = 0; level < n_level; ++level) {
    double const cutoff = std::ldexp(side_, -level);
    Level l;
    l.cutoff2 = static_cast<Real>(cutoff * cutoff);
    l.u_scale = static_cast<Real>(2.0 / (cutoff * cutoff));
    for (double a : local_.a) l.a.push_back(static_cast<Real>(a * std::pow(cutoff, -power)));
    for (double b : local_.b) l.b.push_back(static_cast<Real>(b * std::pow(cutoff, -power - 2)));
    levels_.push_back(std::move(l));
  }
}

template <class Real>
void NearField<Real>::set_points(Octree& tree, ConstPoints sources, ConstPoints targets) {
  auto const& leaves = tree.leaves();
  int exponent = 0;
  side_ = std::frexp(tree.side(), &exponent);
  velocity_scale_ = kernel_ == "stokeslet" ? side_ : side_ * side_;
  make_levels(static_cast<int>(leaves.size()));
  std::vector<std::pair<int, Box const*>> boxes;
  for (std::size_t level = 0; level < leaves.size(); ++level)
    for (Box const& box : leaves[level])
      if (box.targets.size() > 0) boxes.emplace_back(static_cast<int>(level), &box);
  leaves_.assign(boxes.size(), {});
  parallel_for("NearField::set_points::order", static_cast<long>(boxes.size()), [&](long i) {
    Range const range = boxes[i].second->targets;
    std::vector<std::uint32_t> order(range.size());
    std::iota(order.begin(), order.end(), static_cast<std::uint32_t>(range.begin));
    make_compact(tree.targets(), order.data(), order.data() + order.size(), W);
    tree.reorder_targets(range, order);
  });
  copy_points(tree, sources, targets);
  for (int d = 0; d < 3; ++d) {
    filter_[d].assign(tree.sources().size() + lanes<float>, 0.0f);
    for (std::size_t i = 0; i < tree.sources().size(); ++i) filter_[d][i] = static_cast<float>(tree.sources()[i][d]);
  }
  parallel_for("NearField::set_points::list", static_cast<long>(boxes.size()),
               [&](long i) { leaves_[i] = list_sources(tree, boxes[i].first, *boxes[i].second); });
}

// The origin is moved only where the points are far from it, and then by a number with few bits.
template <class Real>
void NearField<Real>::copy_points(Octree const& tree, ConstPoints sources, ConstPoints targets) {
  double const unit = tree.side() / side_;
  Vec3d origin;
  for (int d = 0; d < 3; ++d)
    origin[d] = std::abs(tree.corner()[d]) < 4.0 * unit ? 0.0 : std::floor(tree.corner()[d] / unit) * unit;
  sources_.resize(sources.size());
  targets_.resize(targets.size());
  for (std::size_t i = 0; i < sources.size(); ++i) sources_[i] = (sources[tree.source_order()[i]] - origin) * (1.0 / unit);
  for (std::size_t i = 0; i < targets.size(); ++i) targets_[i] = (targets[tree.target_order()[i]] - origin) * (1.0 / unit);
  records_.assign(sources_.size() * record_, Real(0));
  for (std::size_t i = 0; i < sources_.size(); ++i)
    for (int d = 0; d < 3; ++d) {
      Real const high = static_cast<Real>(sources_[i][d]);
      records_[i * record_ + d] = high;
      if constexpr (split_coordinates) records_[i * record_ + 3 + d] = static_cast<Real>(sources_[i][d] - high);
    }
}

template <class Real>
bool NearField<Real>::is_close(long target, int n_target, std::uint32_t source) const {
  for (long t = target; t < target + n_target; ++t) {
    Vec3d const r = targets_[t] - sources_[source];
    double const r2 = dot(r, r);
    if (r2 > 0.0 && r2 < close_distance * close_distance) return true;
  }
  return false;
}

// Boxes of the target's own level hold only sources as fine or finer; coarser leaves are found around the
// target's ancestors.
template <class Real>
std::vector<typename NearField<Real>::Candidates> NearField<Real>::candidates(Octree const& tree, int level,
                                                                              Box const& box) const {
  std::vector<Candidates> found;
  for (int l = level; l >= 0; --l) {
    int const shift = level - l;
    for (int i = 0; i < 27; ++i) {
      int const x = (box.place[0] >> shift) + i % 3 - 1, y = (box.place[1] >> shift) + i / 3 % 3 - 1,
                z = (box.place[2] >> shift) + i / 9 - 1;
      if (std::min({x, y, z}) < 0 || std::max({x, y, z}) >= 1 << l) continue;
      Box const* near = Octree::find(tree.leaves()[l], x, y, z);
      if (!near && l == level && l < static_cast<int>(tree.refined().size()))
        near = Octree::find(tree.refined()[l], x, y, z);
      if (near && near->sources.size() > 0) found.push_back({l, near->sources});
    }
  }
  return found;
}

template <class Real>
void NearField<Real>::append_near(Range range, Vec3d const& centre, Vec3d const& half, double cutoff,
                                  std::vector<std::uint32_t>& hits) const {
  constexpr int n_lane = lanes<float>;
  using F = Pack<float>;
  float const slack = 4e-7f;  // rounding of normalised float coordinates
  float const reach = static_cast<float>(cutoff) + slack;
  std::size_t n_hit = hits.size();
  hits.resize(n_hit + range.size() + n_lane);
  F const zero{};
  for (long s = range.begin; s < range.end; s += n_lane) {
    F r2 = zero;
    for (int d = 0; d < 3; ++d) {
      F const offset = load(filter_[d].data() + s) - static_cast<float>(centre[d]);
      F const size = offset > zero ? offset : -offset;
      F const beyond = size - static_cast<float>(half[d]);
      F const clipped = beyond > zero ? beyond : zero;
      r2 += clipped * clipped;
    }
    int const n = static_cast<int>(std::min<long>(n_lane, range.end - s));
    for (int i = 0; i < n; ++i) {
      hits[n_hit] = static_cast<std::uint32_t>(s + i);
      n_hit += r2[i] < reach * reach;
    }
  }
  hits.resize(n_hit);
}

template <class Real>
typename NearField<Real>::Leaf NearField<Real>::list_sources(Octree const& tree, int level, Box const& box) const {
  auto const near = candidates(tree, level, box);
  PointArray const& targets = tree.targets();
  Leaf leaf;
  int first_segment = 0;
  for (long t = box.targets.begin; t < box.targets.end; t += W) {
    int const n = static_cast<int>(std::min<long>(W, box.targets.end - t));
    Vec3d low = targets[t], high = low;
    for (int i = 1; i < n; ++i)
      for (int d = 0; d < 3; ++d) {
        low[d] = std::min(low[d], targets[t + i][d]);
        high[d] = std::max(high[d], targets[t + i][d]);
      }
    for (auto const& [l, range] : near) {
      std::size_t const before = leaf.sources.size();
      append_near(range, 0.5 * (low + high), 0.5 * (high - low), std::ldexp(1.0, -l), leaf.sources);
      if constexpr (split_coordinates) {
        auto const first = leaf.sources.begin() + static_cast<long>(before);
        auto const kept = std::stable_partition(first, leaf.sources.end(), [&](std::uint32_t s) {
          bool inside = true;
          for (int d = 0; d < 3; ++d)
            inside = inside && tree.sources()[s][d] > low[d] - 2.0 * close_distance &&
                     tree.sources()[s][d] < high[d] + 2.0 * close_distance;
          return !(inside && is_close(t, n, s));
        });
        leaf.close.insert(leaf.close.end(), kept, leaf.sources.end());
        leaf.close_levels.resize(leaf.close.size(), l);
        leaf.sources.erase(kept, leaf.sources.end());
      }
      if (leaf.sources.size() == before) continue;
      long const end = static_cast<long>(leaf.sources.size());
      if (static_cast<int>(leaf.segments.size()) > first_segment && leaf.segments.back().level == l)
        leaf.segments.back().end = end;
      else
        leaf.segments.push_back({l, end});
    }
    first_segment = static_cast<int>(leaf.segments.size());
    leaf.groups.push_back({t, n, first_segment, static_cast<long>(leaf.close.size())});
  }
  leaf.sources.shrink_to_fit();
  return leaf;
}

template <class Real>
void NearField<Real>::set_strengths(Vec3d const* strengths, Vec3d const* normals) {
  strengths_ = strengths;
  normals_ = normals;
  long const n = static_cast<long>(sources_.size());
  constexpr long block = 4096;
  constexpr int offset = split_coordinates ? 6 : 3;
  parallel_for("NearField::set_strengths", (n + block - 1) / block, [&](long i_block) {
    for (long i = i_block * block; i < std::min(n, (i_block + 1) * block); ++i) {
      Real* const record = records_.data() + i * record_ + offset;
      for (int d = 0; d < 3; ++d) record[d] = static_cast<Real>(strengths[i][d]);
      if (normals)
        for (int d = 0; d < 3; ++d) record[3 + d] = static_cast<Real>(normals[i][d]);
    }
  });
}

template <class Real>
template <class Kernel, int terms>
void NearField<Real>::add_leaf(Leaf const& leaf, Vec3d* velocity) const {
  using P = Pack<Real>;
  constexpr int offset = split_coordinates ? 6 : 3;
  long source = 0, close = 0;
  int segment = 0;
  for (Group const& group : leaf.groups) {
    P x[3], low[3], u[3];
    for (int d = 0; d < 3; ++d) {
      u[d] = P{};
      for (int i = 0; i < W; ++i) {
        double const at = targets_[group.target + std::min(i, group.n_target - 1)][d];
        x[d][i] = static_cast<Real>(at);
        low[d][i] = static_cast<Real>(at - static_cast<Real>(at));
      }
    }
    for (; segment < group.segment_end; ++segment) {
      Level const& level = levels_[leaf.segments[segment].level];
      Real a[terms], b[terms];
      std::copy_n(level.a.data(), terms, a);
      std::copy_n(level.b.data(), terms, b);
      for (; source < leaf.segments[segment].end; ++source) {
        Real const* const record = records_.data() + static_cast<std::size_t>(leaf.sources[source]) * record_;
        P r[3];
        for (int d = 0; d < 3; ++d) {
          r[d] = x[d] - record[d];
          if constexpr (split_coordinates) r[d] += low[d] - record[3 + d];
        }
        P const r2 = r[0] * r[0] + r[1] * r[1] + r[2] * r[2];
        P inverse = reciprocal_square_root<Real, sizeof(Real) == 4 ? 0 : 1>(r2);
        if (refinement_steps_ > 0) inverse = inverse * (Real(1.5) - Real(0.5) * r2 * inverse * inverse);
        inverse = r2 > P{} ? inverse : P{};
        P const w = r2 * level.u_scale - Real(1);
        P pa = broadcast(a[terms - 1]), pb = broadcast(b[terms - 1]);
        for (int k = terms - 2; k >= 0; --k) {
          pa = pa * w + a[k];
          pb = pb * w + b[k];
        }
        Kernel::add(r, inverse, pa, pb, r2 < broadcast(level.cutoff2), record + offset, u);
      }
    }
    for (int i = 0; i < group.n_target; ++i)
      velocity[group.target + i] +=
          velocity_scale_ * Vec3d{static_cast<double>(u[0][i]), static_cast<double>(u[1][i]), static_cast<double>(u[2][i])};
    add_close<Kernel>(leaf, close, group, velocity);
    close = group.close_end;
  }
}

// The same sum in double, one pair at a time.
template <class Real>
template <class Kernel>
void NearField<Real>::add_close(Leaf const& leaf, long begin, Group const& group, Vec3d* velocity) const {
  for (long k = begin; k < group.close_end; ++k)
    for (long t = group.target; t < group.target + group.n_target; ++t) {
      std::uint32_t const s = leaf.close[k];
      Level const& level = levels_[leaf.close_levels[k]];
      double const r[3] = {targets_[t].x - sources_[s].x, targets_[t].y - sources_[s].y, targets_[t].z - sources_[s].z};
      double const r2 = r[0] * r[0] + r[1] * r[1] + r[2] * r[2], w = r2 * level.u_scale - 1.0;
      double a = 0.0, b = 0.0, u[3] = {0.0, 0.0, 0.0};
      for (int i = static_cast<int>(level.a.size()) - 1; i >= 0; --i) {
        a = a * w + level.a[i];
        b = b * w + level.b[i];
      }
      Vec3d const source[2] = {strengths_[s], normals_ ? normals_[s] : Vec3d{}};
      Kernel::add(r, r2 > 0.0 ? 1.0 / std::sqrt(r2) : 0.0, a, b, r2 < level.cutoff2, &source[0].x, u);
      velocity[t] += velocity_scale_ * Vec3d{u[0], u[1], u[2]};
    }
}

template <class Real>
template <class Kernel>
void NearField<Real>::add_with_terms(Leaf const& leaf, Vec3d* velocity) const {
  if constexpr (sizeof(Real) == 4) {
    switch (local_.a.size()) {
      case 4: return add_leaf<Kernel, 4>(leaf, velocity);
      case 8: return add_leaf<Kernel, 8>(leaf, velocity);
      default: return add_leaf<Kernel, 12>(leaf, velocity);
    }
  } else {
    switch (local_.a.size()) {
      case 4: return add_leaf<Kernel, 4>(leaf, velocity);
      case 8: return add_leaf<Kernel, 8>(leaf, velocity);
      case 12: return add_leaf<Kernel, 12>(leaf, velocity);
      case 16: return add_leaf<Kernel, 16>(leaf, velocity);
      case 20: return add_leaf<Kernel, 20>(leaf, velocity);
      case 24: return add_leaf<Kernel, 24>(leaf, velocity);
      case 28: return add_leaf<Kernel, 28>(leaf, velocity);
      default: return add_leaf<Kernel, 32>(leaf, velocity);
    }
  }
}

template <class Real>
void NearField<Real>::add(long item, Vec3d* velocity) const {
  if (kernel_ == "stokeslet") return add_with_terms<NearStokeslet>(leaves_[item], velocity);
  if (kernel_ == "rotlet") return add_with_terms<NearRotlet>(leaves_[item], velocity);
  add_with_terms<NearStresslet>(leaves_[item], velocity);
}

template <class Real>
double NearField<Real>::n_pairs() const {
  double n = 0.0;
  for (Leaf const& leaf : leaves_) n += static_cast<double>(leaf.sources.size()) * W;
  return n;
}

template <class Real>
std::size_t NearField<Real>::memory() const {
  std::size_t bytes = records_.capacity() * sizeof(Real) + leaves_.capacity() * sizeof(Leaf);
  for (Leaf const& leaf : leaves_)
    bytes += leaf.groups.capacity() * sizeof(Group) + leaf.segments.capacity() * sizeof(Segment) +
             (leaf.sources.capacity() + 2 * leaf.close.capacity()) * sizeof(std::uint32_t);
  return bytes + (sources_.capacity() + targets_.capacity()) * sizeof(Vec3d);
}

template class NearField<float>;
template class NearField<double>;

}  // namespace asterflow

#include "backends/fast_device_near.hpp"

#include "backends/fast_kernel.hpp"
#include "base/error.hpp"
#include "kernels/dual.hpp"
#include "kernels/kernel.hpp"

#include "backends/fast_near_kernels.inl"

#include <cmath>

namespace asterflow {
namespace {

template <class Real>
constexpr int n_coordinate = sizeof(Real) == 4 ? 6 : 3;

// A coordinate, at most 8, as one number, or as the sum of two floats, the first a multiple of 2^-21. (A round trip through
// float would do, but g++ 12 optimises it away when it vectorises.)
template <class Real>
void put_point(Real* out, Vec3d const& x) {
  constexpr double shift = 0x1.8p31;
  for (int d = 0; d < 3; ++d) {
    double const high = n_coordinate<Real> == 6 ? (x[d] + shift) - shift : x[d];
    out[d] = static_cast<Real>(high);
    if constexpr (n_coordinate<Real> == 6) out[3 + d] = static_cast<Real>(x[d] - high);
  }
}

template <class Real>
KOKKOS_INLINE_FUNCTION Vec3<Real> distance(Real const* x, Real const* y) {
  Vec3<Real> r{x[0] - y[0], x[1] - y[1], x[2] - y[2]};
  if constexpr (n_coordinate<Real> == 6) r += Vec3<Real>{x[3] - y[3], x[4] - y[4], x[5] - y[5]};
  return r;
}

// u [3] += one pair without its scale; Number: Real, or Dual where the gradient is wanted.
template <class Kernel, class Number, class Real>
KOKKOS_INLINE_FUNCTION void add_pair(DevicePolynomials<Real> const& polynomials, DeviceLevel<Real> const& level,
                                     Vec3<Real> const& x, Number const (&r)[3], Number const& inverse, Number const& w,
                                     Real const* source, int n_strength, Number (&u)[3]) {
  Number a(polynomials.a[polynomials.terms - 1]), b(polynomials.b[polynomials.terms - 1]);
  for (int k = polynomials.terms - 2; k >= 0; --k) {
    a = a * w + Number(polynomials.a[k]);
    b = b * w + Number(polynomials.b[k]);
  }
  Number strength[6] = {Number(Real(0)), Number(Real(0)), Number(Real(0)), Number(Real(0)), Number(Real(0)), Number(Real(0))};
  for (int d = 0; d < n_strength; ++d) strength[d] = Number(source[d]);
  bool const is_inside = dot(x, x) < level.cutoff2;
  auto const inside = [&](Number const& n) { return is_inside ? n : Number(Real(0)); };
  Kernel::add(r, inverse, a * Number(level.a_scale), b * Number(level.b_scale), inside, strength, u);
}

template <class Kernel, class Real>
KOKKOS_INLINE_FUNCTION void add_pair(DevicePolynomials<Real> const& polynomials, DeviceLevel<Real> const& level,
                                     Vec3<Real> const& x, Real const* source, int n_strength, Real (&u)[3]) {
  Real const r[3] = {x.x, x.y, x.z};
  add_pair<Kernel, Real>(polynomials, level, x, r, inverse_distance(x), dot(x, x) * level.x_scale - Real(0.5), source, n_strength, u);
}

template <class Kernel, class Real>
KOKKOS_INLINE_FUNCTION void add_pair(DevicePolynomials<Real> const& polynomials, DeviceLevel<Real> const& level,
                                     Vec3<Real> const& x, Real const* source, int n_strength, Dual<Real> (&u)[3]) {
  using D = Dual<Real>;
  Vec3<D> const y = differentiable(x);
  D const r[3] = {y.x, y.y, y.z}, w = dot(y, y) * D(level.x_scale) - D(Real(0.5));
  add_pair<Kernel, D>(polynomials, level, x, r, differentiable_inverse(x, inverse_distance(x)), w, source, n_strength, u);
}

template <class Real>
KOKKOS_INLINE_FUNCTION void put(Real const (&u)[3], long target, double scale, double, double* velocity, double*) {
  for (int d = 0; d < 3; ++d) velocity[3 * target + d] += scale * static_cast<double>(u[d]);
}
template <class Real>
KOKKOS_INLINE_FUNCTION void put(Dual<Real> const (&u)[3], long target, double scale, double slope_scale, double* velocity,
                                double* slopes) {
  for (int d = 0; d < 3; ++d) {
    velocity[3 * target + d] += scale * static_cast<double>(u[d].value);
    for (int e = 0; e < 3; ++e) slopes[9 * target + 3 * d + e] += slope_scale * static_cast<double>(u[d].slope[e]);
  }
}

// One kernel's sum over the lists, as the functor of a launch: thread i has target i % group_size of group i / group_size.
template <class Kernel, class Number, class Real>
struct ListSum {
  DevicePolynomials<Real> polynomials;
  DeviceArray<DeviceLevel<Real>> levels;
  DeviceArray<DeviceGroup> groups;
  DeviceArray<DeviceSegment> segments;
  DeviceArray<std::uint16_t> list;
  DeviceArray<Real> records, targets;
  DeviceArray<double> velocity, slopes;
  int record, group_size;
  double scale, slope_scale;

  KOKKOS_INLINE_FUNCTION void operator()(long i) const {
    DeviceGroup const& group = groups(i / group_size);
    if (i % group_size >= group.n_target) return;
    long const target = group.target + i % group_size;
    Real x[n_coordinate<Real>];
    for (int d = 0; d < n_coordinate<Real>; ++d) x[d] = targets(target * n_coordinate<Real> + d);
    Number const zero = Real(0);
    Number u[3] = {zero, zero, zero};
    long n_summed = 0;
    for (long s = group.segment_begin; s < group.segment_end; ++s) {
      DeviceSegment const segment = segments(s);
      DeviceLevel<Real> const level = levels(segment.level);
      for (long k = segment.begin; k < segment.end; ++k) {
        Real const* const source = &records((segment.base + static_cast<long>(list(k))) * record);
        add_pair<Kernel, Real>(polynomials, level, distance<Real>(x, source), source + n_coordinate<Real>,
                               record - n_coordinate<Real>, u);
        if (++n_summed < near_run<Real>) continue;
        put(u, target, scale, slope_scale, velocity.data(), slopes.data());
        for (Number& sum : u) sum = zero;
        n_summed = 0;
      }
    }
    put(u, target, scale, slope_scale, velocity.data(), slopes.data());
  }
};

}  // namespace

template <class Real>
DeviceNear<Real>::DeviceNear(FastKernel kernel, LocalPart const& local)
    : kernel_(kernel), record_(n_coordinate<Real> + n_component(kernel)) {
  polynomials_.terms = local.terms;
  ASTERFLOW_REQUIRE(local.pieces == 1 && local.terms <= DevicePolynomials<Real>::max_terms);
  for (std::size_t k = 0; k < local.a.size(); ++k) {
    polynomials_.a[k] = static_cast<Real>(local.a[k]);
    polynomials_.b[k] = static_cast<Real>(local.b[k]);
  }
}

template <class Real>
void DeviceNear<Real>::set_points(NearLists const& lists, bool only_close, ConstPoints normals) {
  only_close ? list_close(lists) : list(lists);
  if (is_empty()) return;
  side_ = lists.side();
  scale_ = std::pow(side_, decay(kernel_)) / (8.0 * M_PI);
  int const power = has_normal(kernel_) ? NearStresslet::powers : NearStokeslet::powers;
  std::vector<DeviceLevel<Real>> levels;
  for (int level = 0; level < lists.n_level(); ++level) {
    double const cutoff = std::ldexp(side_, -level);
    levels.push_back({static_cast<Real>(cutoff * cutoff), static_cast<Real>(1.0 / (cutoff * cutoff)),
                      static_cast<Real>(std::pow(cutoff, -power)), static_cast<Real>(std::pow(cutoff, -power - 2))});
  }
  send(levels_, levels, "levels");
  send_points(lists, normals);
}

// Leaf after leaf.
template <class Real>
void DeviceNear<Real>::list(NearLists const& lists) {
  std::vector<DeviceGroup> groups;
  std::vector<DeviceSegment> segments;
  std::vector<std::uint16_t> list;
  for (NearLists::Leaf const& leaf : lists.leaves()) {
    long const first_segment = static_cast<long>(segments.size()), first = static_cast<long>(list.size());
    long begin = first, segment = first_segment;
    for (NearSegment const& s : leaf.segments) {
      segments.push_back({begin, first + s.end, s.base, s.level});
      begin = first + s.end;
    }
    for (NearGroup const& g : leaf.groups) {
      groups.push_back({g.target, segment, first_segment + g.segment_end, g.n_target});
      segment = first_segment + g.segment_end;
    }
    list.insert(list.end(), leaf.list.begin(), leaf.list.end());
  }
  group_size_ = lists.group_size();
  n_group_ = static_cast<long>(groups.size());
  send(groups_, groups, "groups");
  send(segments_, segments, "segments");
  send(list_, list, "list");
}

// One segment for every source set apart.
template <class Real>
void DeviceNear<Real>::list_close(NearLists const& lists) {
  std::vector<DeviceGroup> groups;
  std::vector<DeviceSegment> segments;
  for (NearLists::Leaf const& leaf : lists.leaves()) {
    for (std::size_t k = 0; k < leaf.close.size();) {
      std::uint32_t const target = leaf.close[k].target;
      long const first = static_cast<long>(segments.size());
      for (; k < leaf.close.size() && leaf.close[k].target == target; ++k)
        segments.push_back({0, 1, leaf.close[k].source, leaf.close[k].level});
      groups.push_back({target, first, static_cast<long>(segments.size()), 1});
    }
  }
  group_size_ = lists.group_size();
  n_group_ = static_cast<long>(groups.size());
  send(groups_, groups, "groups");
  send(segments_, segments, "segments");
  send(list_, std::vector<std::uint16_t>{0}, "list");
}

template <class Real>
void DeviceNear<Real>::send_points(NearLists const& lists, ConstPoints normals) {
  n_source_ = static_cast<long>(lists.sources().size());
  std::vector<Real> records(lists.sources().size() * record_), targets(lists.targets().size() * n_coordinate<Real>);
  for (std::size_t i = 0; i < lists.sources().size(); ++i) {
    Real* const record = records.data() + i * record_;
    put_point(record, lists.sources()[i]);
    for (int d = 0; d < 3 && !normals.empty(); ++d) record[n_coordinate<Real> + 3 + d] = static_cast<Real>(normals[i][d]);
  }
  for (std::size_t i = 0; i < lists.targets().size(); ++i) put_point(targets.data() + i * n_coordinate<Real>, lists.targets()[i]);
  send(records_, records, "records");
  send(targets_, targets, "targets");
}

template <class Real>
void DeviceNear<Real>::put_strengths(DeviceArray<double> const& strengths) const {
  auto const records = records_;
  int const record = record_;
  Kokkos::parallel_for("asterflow::Fast::put_strengths", DeviceRange(0, 3 * n_source_),
                       KOKKOS_LAMBDA(long k) {
                         records(k / 3 * record + n_coordinate<Real> + k % 3) = static_cast<Real>(strengths(k));
                       });
}

template <class Real>
template <class Kernel>
void DeviceNear<Real>::add_of(DeviceArray<double> const& velocity, DeviceArray<double> const& slopes) const {
  DeviceRange const range(0, n_group_ * group_size_);
  auto const launch = [&](auto number) {
    ListSum<Kernel, decltype(number), Real> const sum{polynomials_, levels_,  groups_,  segments_,   list_,  records_,
                                                      targets_,     velocity, slopes,   record_,     group_size_,
                                                      scale_,       scale_ * side_};
    Kokkos::parallel_for("asterflow::Fast::near", range, sum);
  };
  if (slopes.extent(0) > 0)
    launch(Dual<Real>());
  else
    launch(Real());
}

template <class Real>
void DeviceNear<Real>::add(DeviceArray<double> const& strengths, DeviceArray<double> const& velocity,
                           DeviceArray<double> const& slopes) {
  if (is_empty()) return;
  put_strengths(strengths);
  switch (kernel_) {
    case FastKernel::stokeslet: return add_of<NearStokeslet>(velocity, slopes);
    case FastKernel::rotlet: return add_of<NearRotlet>(velocity, slopes);
    case FastKernel::stresslet: return add_of<NearStresslet>(velocity, slopes);
    case FastKernel::stokeslet_pressure: return add_of<NearStokesletPressure>(velocity, slopes);
    case FastKernel::stresslet_pressure: return add_of<NearStressletPressure>(velocity, slopes);
  }
}

template <class Real>
std::size_t DeviceNear<Real>::memory() const {
  return sizeof(Real) * (records_.size() + targets_.size()) + sizeof(DeviceGroup) * groups_.size() +
         sizeof(DeviceSegment) * segments_.size() + sizeof(std::uint16_t) * list_.size();
}

template class DeviceNear<float>;
template class DeviceNear<double>;

}  // namespace asterflow

// The pair loop, written once for every kernel, arithmetic and instruction set. Included by the
// pair_sums_<instructions>.cpp after the Pack of that instruction set; everything here is in an unnamed
// namespace, so that no code compiled for one instruction set can be linked into another.
//
// Targets lie in the lanes of vector registers, sources are broadcast from contiguous records. One pair
// costs, besides three subtractions, the multiplications and fused multiply-adds of |r|^2 (3), of the
// correction of 1 / |r| (3 + steps, none for steps = 0), and of the kernel's shape() (Stokeslet 11,
// stresslet 14, rotlet 11). Acting both ways shares all but the strength-dependent part.

#include "backends/pair_sums.hpp"
#include "kernels/dual.hpp"
#include "kernels/list.hpp"

#include <tuple>
#include <utility>

namespace asterflow {
namespace {

// Squared distances below this count as zero. Coordinates are scaled so that no pair that matters comes near it.
constexpr float smallest_square = 0x1p-126f;

template <class Real>
constexpr int coordinate_count = sizeof(Real) == 4 ? 6 : 3;  // n_coordinates of frame.hpp

template <class Real>
using Simd = typename Pack<Real>::Vector;

// Coefficients c0 + c1 e + c2 e^2 + ... of 1 / sqrt(1 - e) for |e| <= 2 (estimate error): the binomial series, and
// its first neglected term spread evenly over that interval (Chebyshev) where it is above rounding.
template <class Real, int steps>
struct InverseSqrtSeries {
  static constexpr double range = 2.0 * Pack<Real>::estimate_error;
  static constexpr double c[] = {1.0 + (steps == 1 ? 3.0 / 16 * range * range : 0.0),
                                 1.0 / 2 + (steps == 2 ? 15.0 / 64 * range * range : 0.0), 3.0 / 8, 5.0 / 16, 35.0 / 128};
  static constexpr double neglected[] = {1.0 / 2, 3.0 / 16, 5.0 / 64, 35.0 / 128, 63.0 / 256};

  static constexpr double error() {
    double bound = 1.001 * neglected[steps];
    for (int k = 0; k <= steps; ++k) bound *= range;
    return bound;
  }
};

// y (c0 + c1 e + c2 e^2 + ...) = 1 / sqrt(a) for an estimate y, with e = 1 - a y^2.
template <class Real, int steps>
inline Simd<Real> inverse_sqrt(Simd<Real> a) {
  constexpr auto& c = InverseSqrtSeries<Real, steps>::c;
  Simd<Real> const y = Pack<Real>::inverse_sqrt_estimate(a);
  if constexpr (steps == 0) {
    return Pack<Real>::positive_part(y);
  } else {
    Simd<Real> const e = Real(1) - a * (y * y);
    Simd<Real> series = Pack<Real>::splat(Real(c[steps]));
    for (int k = steps - 1; k >= 0; --k) series = series * e + Real(c[k]);
    return Pack<Real>::positive_part(y * series);
  }
}

template <class Real>
inline Vec3<Simd<Real>> load(Real const* lane_group) {
  using Vector = Simd<Real>;
  auto const* v = reinterpret_cast<Vector const*>(lane_group);
  return {v[0], v[1], v[2]};
}

template <class Real>
inline Vec3<Simd<Real>> splat(Real const* record) {
  return {Pack<Real>::splat(record[0]), Pack<Real>::splat(record[1]), Pack<Real>::splat(record[2])};
}

// target - source
template <class Real>
struct Coordinates {
  Vec3<Simd<Real>> high, low;

  explicit Coordinates(Real const* lane_group) : high(load(lane_group)) {
    if constexpr (coordinate_count<Real> == 6) low = load(lane_group + 3 * Pack<Real>::lanes);
  }
  Vec3<Simd<Real>> minus(Real const* record) const {
    if constexpr (coordinate_count<Real> == 6) return (high - splat(record)) + (low - splat(record + 3));
    return high - splat(record);
  }
};

// Adds three registers to velocity [3, lanes] in double.
template <class Real>
inline void add_to(double* velocity, Vec3<Simd<Real>> const& u) {
  constexpr int lanes = Pack<Real>::lanes;
  for (int c = 0; c < 3; ++c) {
    alignas(64) Real part[lanes];
    *reinterpret_cast<Simd<Real>*>(part) = u[c];
    for (int i = 0; i < lanes; ++i) velocity[c * lanes + i] += double(part[i]);
  }
}

// Sums of neighbouring lanes: a0+a1, a2+a3, ..., b0+b1, b2+b3, ...
template <class Vector, int... i>
inline Vector neighbour_sums(Vector a, Vector b, std::integer_sequence<int, i...>) {
  return __builtin_shufflevector(a, b, 2 * i...) + __builtin_shufflevector(a, b, (2 * i + 1)...);
}

// Lane i of the result is the sum over the lanes of parts[i].
template <class Real>
inline Simd<Real> lane_sums(Simd<Real> (&parts)[Pack<Real>::lanes]) {
  for (int n = Pack<Real>::lanes / 2; n > 0; n /= 2)
    for (int i = 0; i < n; ++i)
      parts[i] = neighbour_sums(parts[2 * i], parts[2 * i + 1], std::make_integer_sequence<int, Pack<Real>::lanes>{});
  return parts[0];
}

template <class Kernel, class Real, int steps>
struct PairLoop {
  using Vector = Simd<Real>;
  static constexpr int lanes = Pack<Real>::lanes;
  static constexpr int n_coordinates = coordinate_count<Real>;
  static constexpr int n_source = n_coordinates + (Kernel::has_normal ? 6 : 3);
  static constexpr int groups_at_once = Pack<Real>::groups_at_once;
  static constexpr long sources_at_once = 256;  // summed in Real before they are added in double

  static Vector inverse_distance(Vec3<Vector> const& r) {
    return inverse_sqrt<Real, steps>(r.x * r.x + (r.y * r.y + (r.z * r.z - Real(smallest_square))));
  }

  template <int groups>
  struct Groups {
    Coordinates<Real> of[groups];
  };

  // Coordinates of consecutive lane groups that are `stride` numbers apart.
  template <int groups>
  static Groups<groups> coordinates(Real const* first, long stride) {
    return [=]<int... i>(std::integer_sequence<int, i...>) {
      return Groups<groups>{{Coordinates<Real>(first + i * stride)...}};
    }(std::make_integer_sequence<int, groups>{});
  }

  template <int groups>
  static void add_one_way_tile(Real const* targets, long stride, Real const* sources, long n, double* velocity) {
    Vec3<Vector> u[groups];
    auto const x = coordinates<groups>(targets, stride);
    for (Real const* source = sources; source != sources + n * n_source; source += n_source) {
      Vec3<Vector> const q = splat(source + n_coordinates);
      Vec3<Vector> n{};
      if constexpr (Kernel::has_normal) n = splat(source + n_coordinates + 3);
      for (int i = 0; i < groups; ++i) {
        Vec3<Vector> const r = x.of[i].minus(source);
        u[i] += Kernel::template shape<Vector>(r, inverse_distance(r), q, n);
      }
    }
    for (int i = 0; i < groups; ++i) add_to<Real>(velocity + i * 3 * lanes, u[i]);
  }

  static void add_one_way(Real const* targets, long n_group, long stride, Real const* sources, long n,
                          double* velocity) {
    for (long first = 0; first < n; first += sources_at_once) {
      Real const* const tile = sources + first * n_source;
      long const n_tile = n - first < sources_at_once ? n - first : sources_at_once;
      long g = 0;
      for (; g + groups_at_once <= n_group; g += groups_at_once)
        add_one_way_tile<groups_at_once>(targets + g * stride, stride, tile, n_tile, velocity + g * 3 * lanes);
      for (; g < n_group; ++g)
        add_one_way_tile<1>(targets + g * stride, stride, tile, n_tile, velocity + g * 3 * lanes);
    }
  }

  // Velocities as numbers that carry their gradient.
  static void add_gradient(Real const* targets, long n_group, long stride, Real const* sources, long n,
                           double* gradient) {
    using D = Dual<Vector>;
    for (long g = 0; g < n_group; ++g) {
      Coordinates<Real> const x(targets + g * stride);
      Vec3<D> u;
      for (long j = 0; j < n; ++j) {
        Real const* const source = sources + j * n_source;
        Vec3<Vector> const r = x.minus(source), q = splat(source + n_coordinates);
        Vec3<Vector> normal{};
        if constexpr (Kernel::has_normal) normal = splat(source + n_coordinates + 3);
        u += Kernel::template shape<D>(differentiable(r), differentiable_inverse(r, inverse_distance(r)),
                                       {q.x, q.y, q.z}, {normal.x, normal.y, normal.z});
        if (j % sources_at_once != sources_at_once - 1 && j + 1 < n) continue;
        for (int i = 0; i < 3; ++i)
          add_to<Real>(gradient + (9 * g + 3 * i) * lanes, Vec3<Vector>{u[i].slope[0], u[i].slope[1], u[i].slope[2]});
        u = {};
      }
    }
  }

  // `groups` lane groups of rows against all columns; reaction [n_column, 3] registers. Distances are computed one
  // column ahead, which gives the processor two independent strands of work.
  template <int groups>
  static void add_both_ways_tile(Real const* rows, Real const* columns, long n_column, double* row_velocity,
                                 Vec3<Vector>* reaction) {
    auto const x = coordinates<groups>(rows, n_source * lanes);
    Vec3<Vector> u[groups], r_next[groups];
    Vector s_next[groups];
    for (int i = 0; i < groups; ++i) {
      r_next[i] = x.of[i].minus(columns);
      s_next[i] = inverse_distance(r_next[i]);
    }
    for (long j = 0; j < n_column; ++j) {
      Real const* const column = columns + j * n_source;
      Real const* const next = column + n_source;
      Vec3<Vector> const q = splat(column + n_coordinates);
      Vec3<Vector> n{};
      if constexpr (Kernel::has_normal) n = splat(column + n_coordinates + 3);
      Vec3<Vector> back = reaction[j];
      for (int i = 0; i < groups; ++i) {
        Vec3<Vector> const r = r_next[i];
        Vector const s = s_next[i];
        r_next[i] = x.of[i].minus(next);
        s_next[i] = inverse_distance(r_next[i]);
        Real const* const row = rows + (i * n_source + n_coordinates) * lanes;
        Vec3<Vector> const q_row = load(row);
        Vec3<Vector> n_row{};
        if constexpr (Kernel::has_normal) n_row = load(row + 3 * lanes);
        u[i] += Kernel::template shape<Vector>(r, s, q, n);
        if constexpr (Kernel::parity > 0)
          back += Kernel::template shape<Vector>(r, s, q_row, n_row);
        else
          back -= Kernel::template shape<Vector>(r, s, q_row, n_row);
      }
      reaction[j] = back;
    }
    for (int i = 0; i < groups; ++i) add_to<Real>(row_velocity + i * 3 * lanes, u[i]);
  }

  static void add_both_ways(Real const* rows, long n_group, Real const* columns, long n_column, double* row_velocity,
                            double* column_velocity) {
    Vec3<Vector> reaction[PairSums<Real>::max_column];
    for (long j = 0; j < n_column; ++j) reaction[j] = {};
    long g = 0;
    for (; g + groups_at_once <= n_group; g += groups_at_once)
      add_both_ways_tile<groups_at_once>(rows + g * n_source * lanes, columns, n_column, row_velocity + g * 3 * lanes,
                                         reaction);
    for (; g < n_group; ++g)
      add_both_ways_tile<1>(rows + g * n_source * lanes, columns, n_column, row_velocity + g * 3 * lanes, reaction);
    for (long j = 0; j < n_column; j += lanes) {
      Vec3<Vector> total;
      for (int c = 0; c < 3; ++c) {
        Vector parts[lanes];
        for (int i = 0; i < lanes; ++i) parts[i] = reaction[j + i][c];
        total[c] = lane_sums<Real>(parts);
      }
      add_to<Real>(column_velocity + 3 * j, total);
    }
  }
};

template <class Kernel, class Real, int steps>
PairSums<Real> pair_sums() {
  using Loop = PairLoop<Kernel, Real, steps>;
  return {Pack<Real>::lanes, steps, InverseSqrtSeries<Real, steps>::error(), Loop::add_one_way, Loop::add_both_ways, Loop::add_gradient};
}

template <class Kernel, class Real, int... steps>
PairSums<Real> pair_sums_with(int wanted_steps, std::integer_sequence<int, steps...>) {
  PairSums<Real> found;
  ((steps == wanted_steps ? void(found = pair_sums<Kernel, Real, steps>()) : void()), ...);
  return found;
}

template <class Real, class... Kernel>
PairSums<Real> pair_sums_of(int i_kernel, int steps, std::tuple<Kernel...> const*) {
  constexpr int max_steps = sizeof(Real) == 4 ? 2 : 4;
  PairSums<Real> found;
  int i = 0;
  ((i++ == i_kernel
        ? void(found = pair_sums_with<Kernel, Real>(steps, std::make_integer_sequence<int, max_steps + 1>{}))
        : void()),
   ...);
  return found;
}

}  // namespace
}  // namespace asterflow

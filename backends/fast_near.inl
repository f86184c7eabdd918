// The near field's loops: targets lie in vector lanes, sources are broadcast from their records.

#include "backends/fast_near_kernels.inl"

namespace asterflow {
namespace {

#if defined(__AVX512F__)
template <class Kernel>
void add_outer(NearWork<double> const& work, double* velocity);
#endif

template <class Real>
struct NearLoop {
  using P = Pack<Real>;
  static constexpr int W = lanes<Real>;
  static constexpr int offset = sizeof(Real) == 4 ? 6 : 3;  // of the strength in a record

  struct Targets {
    P x[3], low[3];  // coordinates; what float leaves of them

    Targets(double const* targets, NearGroup const& group) {
      for (int d = 0; d < 3; ++d)
        for (int i = 0; i < W; ++i) {
          double const at = targets[3 * (group.target + smaller(i, group.n_target - 1)) + d];
          x[d][i] = static_cast<Real>(at);
          low[d][i] = static_cast<Real>(at - static_cast<Real>(at));
        }
    }
    void minus(Real const* record, P (&r)[3]) const {
      for (int d = 0; d < 3; ++d) {
        r[d] = x[d] - record[d];
        if constexpr (sizeof(Real) == 4) r[d] += low[d] - record[3 + d];
      }
    }
  };

  // From an estimate y by the series of 1 / sqrt(1 - e), e = 1 - r2 y^2. Of AVX-512's estimate one term leaves 6e-9, two 6e-13.
  static P inverse_distance(P r2, int refinement_steps) {
    constexpr bool is_rough = sizeof(Real) == 8 || pack_bytes == 32;
    P const y = reciprocal_square_root<Real>(r2);
    int const terms = estimates_root<Real> ? refinement_steps + is_rough : 0;
    if (terms == 0) return y;
    P const e = Real(1) - r2 * (y * y), ye = y * e;
    if (terms == 1) return y + Real(0.5) * ye;
    if (terms == 2) return y + ye * (Real(0.5) + Real(0.375) * e);
    return y + ye * (Real(0.5) + e * (Real(0.375) + Real(0.3125) * e));
  }

  template <int n>
  struct Sums {
    double at[n][W] = {};
    void add(int k, P const& u) {
      for (int i = 0; i < W; ++i) at[k][i] += static_cast<double>(u[i]);
    }
  };

  // Adds u [3] of one group to velocity.
  template <int n>
  static void add_to(double* velocity, NearGroup const& group, double scale, Sums<n> const& u) {
    for (int i = 0; i < group.n_target; ++i)
      for (int d = 0; d < 3; ++d) velocity[3 * (group.target + i) + d] += scale * u.at[d][i];
  }

  // What the pairs of n sources with a vector of targets need of their distances; side by side, since every
  // polynomial is a chain of operations that wait for each other.
  template <int terms, int n>
  struct Pairs {
    P r[n][3], r2[n], inverse[n], a[n], b[n];

    Pairs(NearWork<Real> const& work, NearLevel<Real> const& level, Targets const& targets, Real const* const (&records)[n]) {
      for (int i = 0; i < n; ++i) {
        targets.minus(records[i], r[i]);
        r2[i] = r[i][0] * r[i][0] + r[i][1] * r[i][1] + r[i][2] * r[i][2];
        inverse[i] = inverse_distance(r2[i], work.refinement_steps);
      }
      Place<Real> at[n];
      for (int i = 0; i < n; ++i) {
        at[i] = Place<Real>(r2[i] * level.to_pieces - Real(0.5));
        a[i] = at[i].coefficient(level.a + (terms - 1) * near_pieces<Real>);
        b[i] = at[i].coefficient(level.b + (terms - 1) * near_pieces<Real>);
      }
      for (int k = terms - 2; k >= 0; --k)
        for (int i = 0; i < n; ++i) {
          a[i] = a[i] * at[i].rest + at[i].coefficient(level.a + k * near_pieces<Real>);
          b[i] = b[i] * at[i].rest + at[i].coefficient(level.b + k * near_pieces<Real>);
        }
    }
  };

  // The strengths of the group's own points, zero in lanes without; they are sources where there are reactions.
  struct Strengths {
    P at[6] = {};

    Strengths(NearWork<Real> const& work, NearGroup const& group) {
      if (!work.reactions) return;
      for (int d = 0; d < work.record - offset; ++d)
        for (int i = 0; i < W; ++i)
          at[d][i] = i < group.n_target ? work.records[(group.target + i) * work.record + offset + d] : Real(0);
    }
  };

  // u += n sources of a segment, from place k of the list on; their reactions with it.
  template <class Kernel, int terms, bool has_reactions, int n>
  static void add_sources(NearWork<Real> const& work, NearSegment const& segment, long k, Targets const& targets,
                          Strengths const& strengths, P (&u)[3]) {
    NearLevel<Real> const& level = work.levels[segment.level];
    Real const* records[n];
    for (int i = 0; i < n; ++i) records[i] = work.records + (static_cast<long>(segment.base) + work.list[k + i]) * work.record;
    Pairs<terms, n> const pairs(work, level, targets, records);
    for (int i = 0; i < n; ++i) {
      auto const is_inside = less(pairs.r2[i], broadcast(level.cutoff2));
      auto const inside = [&](P const& x) { return only(is_inside, x); };
      Kernel::add(pairs.r[i], pairs.inverse[i], pairs.a[i], pairs.b[i], inside, records[i] + offset, u);
      if constexpr (has_reactions) {
        P v[3] = {P{}, P{}, P{}};
        Kernel::add(pairs.r[i], pairs.inverse[i], pairs.a[i], pairs.b[i], inside, strengths.at, v);
        add_lane_sums<Kernel::parity, Real>(v, work.reactions + 4 * (long{segment.reaction} + work.list[k + i]));
      }
    }
  }

  // Those of one run.
  template <class Kernel, int terms, bool has_reactions>
  static void add_run(NearWork<Real> const& work, NearSegment const& segment, long begin, long end, Targets const& targets,
                      Strengths const& strengths, P (&u)[3]) {
    long k = begin;
    for (; k + 2 <= end; k += 2) add_sources<Kernel, terms, has_reactions, 2>(work, segment, k, targets, strengths, u);
    if (k < end) add_sources<Kernel, terms, has_reactions, 1>(work, segment, k, targets, strengths, u);
  }

  template <class Kernel, int terms>
  static void add(NearWork<Real> const& work, double* velocity) {
    long source = 0, segment = 0;
    for (long g = 0; g < work.n_group; ++g) {
      NearGroup const& group = work.groups[g];
      Targets const targets(work.targets, group);
      Strengths const strengths(work, group);
      Sums<3> sums;
      P u[3] = {P{}, P{}, P{}};
      long n_summed = 0;
      while (segment < group.segment_end) {
        NearSegment const& piece = work.segments[segment];
        long const end = smaller(long{piece.end}, source + near_run<Real> - n_summed);
        if (piece.reaction == NearSegment::one_way)
          add_run<Kernel, terms, false>(work, piece, source, end, targets, strengths, u);
        else
          add_run<Kernel, terms, true>(work, piece, source, end, targets, strengths, u);
        n_summed += end - source;
        source = end;
        if (source == piece.end) ++segment;
        if (n_summed < near_run<Real> && segment < group.segment_end) continue;
        for (int d = 0; d < 3; ++d) {
          sums.add(d, u[d]);
          u[d] = P{};
        }
        n_summed = 0;
      }
      add_to(velocity, group, work.velocity_scale, sums);
    }
  }

  // A polynomial and its derivative, as a number that depends on the target through x.
  static Dual<P> polynomial(Real const* c, int terms, Place<Real> const& x, P const (&slope)[3]) {
    P value = x.coefficient(c + (terms - 1) * near_pieces<Real>), derivative{};
    for (int k = terms - 2; k >= 0; --k) {
      derivative = derivative * x.rest + value;
      value = value * x.rest + x.coefficient(c + k * near_pieces<Real>);
    }
    return {value, derivative * slope[0], derivative * slope[1], derivative * slope[2]};
  }

  template <class Kernel>
  static void add_pair_gradient(NearWork<Real> const& work, NearLevel<Real> const& level, Targets const& targets,
                                Real const* record, Dual<P> (&u)[3]) {
    using D = Dual<P>;
    P r[3];
    targets.minus(record, r);
    P const r2 = r[0] * r[0] + r[1] * r[1] + r[2] * r[2];
    P const s = inverse_distance(r2, sizeof(Real) == 4 ? 1 : 2), one = broadcast(Real(1));
    P const slope[3] = {r[0] * (2 * level.to_pieces), r[1] * (2 * level.to_pieces), r[2] * (2 * level.to_pieces)};
    Place<Real> const place(r2 * level.to_pieces - Real(0.5));
    D const x[3] = {{r[0], one, P{}, P{}}, {r[1], P{}, one, P{}}, {r[2], P{}, P{}, one}};
    D const inverse = differentiable_inverse(Vec3<P>{r[0], r[1], r[2]}, s);
    auto const is_inside = less(r2, broadcast(level.cutoff2));
    auto const inside = [&](D const& n) {
      return D{only(is_inside, n.value), only(is_inside, n.slope[0]), only(is_inside, n.slope[1]), only(is_inside, n.slope[2])};
    };
    D strength[6];
    for (int d = 0; d < work.record - offset; ++d) strength[d] = broadcast(record[offset + d]);
    Kernel::add(x, inverse, polynomial(level.a, work.terms, place, slope), polynomial(level.b, work.terms, place, slope), inside,
                strength, u);
  }

  // Velocity and gradient.
  template <class Kernel>
  static void add_gradient(NearWork<Real> const& work, double* velocity, double* gradient) {
    using D = Dual<P>;
    long source = 0, segment = 0;
    for (long g = 0; g < work.n_group; ++g) {
      NearGroup const& group = work.groups[g];
      Targets const targets(work.targets, group);
      Sums<12> sums;  // velocity, gradient
      for (; segment < group.segment_end; ++segment) {
        NearSegment const& piece = work.segments[segment];
        NearLevel<Real> const& level = work.levels[piece.level];
        while (source < piece.end) {
          D u[3];
          for (long const stop = smaller(long{piece.end}, source + near_run<Real>); source < stop; ++source)
            add_pair_gradient<Kernel>(work, level, targets, work.records + (piece.base + work.list[source]) * static_cast<long>(work.record), u);
          for (int d = 0; d < 3; ++d) {
            sums.add(d, u[d].value);
            for (int e = 0; e < 3; ++e) sums.add(3 + 3 * d + e, u[d].slope[e]);
          }
        }
      }
      add_to(velocity, group, work.velocity_scale, sums);
      for (int i = 0; i < group.n_target; ++i)
        for (int d = 0; d < 9; ++d) gradient[9 * (group.target + i) + d] += work.gradient_scale * sums.at[3 + d][i];
    }
  }

  // The loop for work.terms, the first of those compiled at or after `terms`.
  template <class Kernel, int terms = near_polynomials<Real>.fewest>
  static void add_of(NearWork<Real> const& work, double* velocity, double* gradient) {
    constexpr int next = terms + near_polynomials<Real>.step;
    if (gradient) return add_gradient<Kernel>(work, velocity, gradient);
    if constexpr (next <= near_polynomials<Real>.most)
      if (work.terms > terms) return add_of<Kernel, next>(work, velocity, gradient);
    add<Kernel, terms>(work, velocity);
#if defined(__AVX512F__)
    if constexpr (sizeof(Real) == 8)
      if (work.outer_levels) add_outer<Kernel>(work, velocity);
#endif
  }
};

template <class Real>
void add_near(NearWork<Real> const& work, double* velocity, double* gradient) {
  using Loop = NearLoop<Real>;
  if (work.kernel == FastKernel::stokeslet) return Loop::template add_of<NearStokeslet>(work, velocity, gradient);
  if (work.kernel == FastKernel::rotlet) return Loop::template add_of<NearRotlet>(work, velocity, gradient);
  if (work.kernel == FastKernel::stresslet) return Loop::template add_of<NearStresslet>(work, velocity, gradient);
  if (work.kernel == FastKernel::stokeslet_pressure)
    return Loop::template add_of<NearStokesletPressure>(work, velocity, gradient);
  Loop::template add_of<NearStressletPressure>(work, velocity, gradient);
}

// One bit per lane: whether it is below the limit.
inline unsigned lanes_below(Pack<float> x, float limit) {
#if defined(__AVX512F__)
  return _mm512_cmp_ps_mask((__m512)x, _mm512_set1_ps(limit), _CMP_LT_OQ);
#elif defined(__AVX2__)
  return static_cast<unsigned>(_mm256_movemask_ps(_mm256_cmp_ps((__m256)x, _mm256_set1_ps(limit), _CMP_LT_OQ)));
#else
  unsigned bits = 0;
  for (int i = 0; i < lanes<float>; ++i) bits |= unsigned(x[i] < limit) << i;
  return bits;
#endif
}

inline Pack<float> larger(Pack<float> a, Pack<float> b) {
#if defined(__AVX512F__)
  return (Pack<float>)_mm512_max_ps((__m512)a, (__m512)b);
#elif defined(__AVX2__)
  return (Pack<float>)_mm256_max_ps((__m256)a, (__m256)b);
#else
  return a > b ? a : b;
#endif
}

// first + i for the bits i of hits, with room for a vector.
inline void put_places(std::uint16_t* places, unsigned hits, int first) {
#if defined(__AVX512F__)
  __m512i const all = _mm512_add_epi32(_mm512_set1_epi32(first), _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15));
  __m256i const some = _mm512_cvtepi32_epi16(_mm512_maskz_compress_epi32(static_cast<__mmask16>(hits), all));
  std::memcpy(places, &some, sizeof some);
#else
  for (; hits != 0; hits &= hits - 1) *places++ = static_cast<std::uint16_t>(first + __builtin_ctz(hits));
#endif
}

// First against the box of the targets, then against each of them: |s - t|^2 = |s|^2 - (2 s.t - |t|^2) about the middle of the
// box, to some roundings of the square of the reach.
inline void list_near(NearQuery const& query, long begin, long end, long base, NearFound& found) {
  using F = Pack<float>;
  constexpr int W = lanes<float>;
  constexpr float rounding = 4e-6f;
  bool const puts_apart = query.inner < query.reach;
  float const inner2 = query.inner * query.inner;
  float const reach2 = (1.0f + rounding) * query.reach * query.reach;
  float const touch2 = NearQuery::touch * NearQuery::touch + rounding * query.reach * query.reach;
  for (long s = begin; s < end; s += W) {
    F x[3], beyond2{}, square{};
    for (int d = 0; d < 3; ++d) {
      x[d] = load(query.sources[d] + s) - query.middle[d];
      F const beyond = larger(larger(x[d], -x[d]) - query.half[d], F{});
      beyond2 += beyond * beyond;
      square += x[d] * x[d];
    }
    if (lanes_below(beyond2, reach2) == 0) continue;
    F most = F{} - 1e30f;
    for (int t = 0; t < query.n_target; ++t)
      most = larger(most, x[0] * query.targets[0][t] + (x[1] * query.targets[1][t] + (x[2] * query.targets[2][t] - query.squares[t])));
    F const least = square - most;
    unsigned hits = lanes_below(least, reach2);
    if (end - s < W) hits &= (1u << (end - s)) - 1u;
    unsigned const outer = puts_apart ? hits & ~lanes_below(least, inner2) : 0u;
    hits &= ~outer;
    put_places(found.sources + found.n_source, hits, static_cast<int>(s - base));
    for (unsigned touching = hits & lanes_below(least, touch2); touching != 0; touching &= touching - 1) {
      unsigned const before = hits & ((touching & -touching) - 1u);
      found.touching[found.n_touching++] = static_cast<std::uint16_t>(found.n_source + __builtin_popcount(before));
    }
    found.n_source += __builtin_popcount(hits);
    if (outer == 0) continue;
    put_places(found.outer + found.n_outer, outer, static_cast<int>(s - base));
    found.n_outer += __builtin_popcount(outer);
  }
}

}  // namespace
}  // namespace asterflow

// The local part of outer sources, in float though the rest is in double. Sources lie in vector lanes, so that reactions
// and velocities are summed lane by lane; coordinates count from the middle of the targets.

namespace asterflow {
namespace {

#if defined(__AVX512F__)

// Transposes the four squares of 4 x 4 numbers that lie side by side in 4 vectors.
inline void transpose_squares(float* rows) {
  using F = Pack<float>;
  using D = Pack<double>;
  F const a = load(rows), b = load(rows + 16), c = load(rows + 32), d = load(rows + 48);
  D const low[2] = {(D)__builtin_shufflevector(a, b, 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29),
                    (D)__builtin_shufflevector(c, d, 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29)};
  D const high[2] = {(D)__builtin_shufflevector(a, b, 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11, 27, 14, 30, 15, 31),
                     (D)__builtin_shufflevector(c, d, 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11, 27, 14, 30, 15, 31)};
  store(rows, (F)__builtin_shufflevector(low[0], low[1], 0, 8, 2, 10, 4, 12, 6, 14));
  store(rows + 16, (F)__builtin_shufflevector(low[0], low[1], 1, 9, 3, 11, 5, 13, 7, 15));
  store(rows + 32, (F)__builtin_shufflevector(high[0], high[1], 0, 8, 2, 10, 4, 12, 6, 14));
  store(rows + 48, (F)__builtin_shufflevector(high[0], high[1], 1, 9, 3, 11, 5, 13, 7, 15));
}

template <class Kernel>
class OuterSources {
  using F = Pack<float>;
  static constexpr int W = lanes<float>, n_strength = Kernel::powers == 3 ? 6 : 3, record = 3 + n_strength;
  static constexpr int n_column = 4 * ((record + 3) / 4);
  static constexpr int room = 256;
  static constexpr float nowhere = 1e6f;

 public:
  OuterSources(NearWork<double> const& work, NearGroup const& group) : work_(work), group_(group) {
    double const* const first = work.targets + 3 * group.target;
    for (int d = 0; d < 3; ++d) {
      double low = first[d], high = first[d];
      for (int t = 1; t < group.n_target; ++t) {
        low = first[3 * t + d] < low ? first[3 * t + d] : low;
        high = first[3 * t + d] > high ? first[3 * t + d] : high;
      }
      middle_[d] = 0.5 * (low + high);
    }
    if (!work.reactions) return;
    for (int t = 0; t < group.n_target; ++t)
      for (int d = 0; d < n_strength; ++d) target_[t][3 + d] = static_cast<float>(work.records[(group.target + t) * record + 3 + d]);
  }

  bool is_full() const { return n_ == room; }

  // Sources of a segment from place k of the list on, as far as there is room; returns the next place.
  long append(NearSegment const& segment, long k) {
    double const to_cutoff = work_.outer_levels[segment.level].to_cutoff;
    __m256d const middle = _mm256_setr_pd(middle_[0], middle_[1], middle_[2], 0.0);
    __m256d const unit = _mm256_setr_pd(to_cutoff, to_cutoff, to_cutoff, 1.0);
    double* const reactions = segment.reaction == NearSegment::one_way ? nullptr : work_.reactions + 4 * long{segment.reaction};
    double const* const records = work_.records + static_cast<long>(segment.base) * record;
    std::uint16_t const* const list = work_.outer_list + k;
    unsigned const first = n_, end = smaller(static_cast<long>(segment.end) - k, long{room} - n_) + n_;
    for (unsigned i = first; i < end; ++i) {
      long const at = list[i - first];
      double const* const source = records + at * record;
      float* const row = row_of(i);
      _mm_store_ps(row, _mm256_cvtpd_ps(_mm256_mul_pd(unit, _mm256_sub_pd(_mm256_loadu_pd(source), middle))));
      for (int part = 1; part < n_column / 4; ++part)
        _mm_store_ps(row + part * 4 * W, _mm256_cvtpd_ps(_mm256_loadu_pd(source + smaller(4 * part, record - 4))));
      reactions_[i] = reactions + (reactions ? 4 * at : 0);
    }
    n_ = static_cast<int>(end);
    return k + end - first;
  }

  // Adds the velocities [n_target, 4] at the group's targets; empties the list.
  template <int terms, bool has_reactions>
  void add(OuterLevel const& level, double* velocity) {
    for (int i = n_; i % W != 0; ++i) {
      float* const row = row_of(i);
      _mm_store_ps(row, _mm_set1_ps(nowhere));
      for (int part = 1; part < n_column / 4; ++part) _mm_store_ps(row + part * 4 * W, _mm_setzero_ps());
    }
    for (int t = 0; t < group_.n_target; ++t)
      for (int d = 0; d < 3; ++d)
        target_[t][d] = static_cast<float>((work_.targets[3 * (group_.target + t) + d] - middle_[d]) * level.to_cutoff);
    F u[lanes<double>][3] = {};
    for (int begin = 0; begin < n_; begin += W) {
      float* const rows = rows_ + begin * n_column;
      for (int part = 0; part < n_column / 4; ++part) transpose_squares(rows + part * 4 * W);
      F x[3], strength[n_strength], v[3] = {};
      for (int d = 0; d < 3; ++d) x[d] = load(rows + d * W);
      for (int d = 0; d < n_strength; ++d) strength[d] = load(rows + column(3 + d) * W);
      for (int t = 0; t < group_.n_target; ++t) add_pairs<terms, has_reactions>(level, target_[t], x, strength, u[t], v);
      if constexpr (has_reactions) add_reactions(v, begin);
    }
    for (int t = 0; t < group_.n_target; ++t, velocity += 4) {
      float sum[4] = {};
      add_lane_sums<1, float>(u[t], sum);
      for (int d = 0; d < 3; ++d) velocity[d] += static_cast<double>(sum[d]);
    }
    n_ = 0;
  }

 private:
  // The first four numbers of source i.
  float* row_of(unsigned i) { return rows_ + i / W * (W * n_column) + i % W * 4; }

  // Where number d of a record lies: the last part of a record overlaps the one before.
  static constexpr int column(int d) {
    int const part = d / 4;
    return 4 * part + (4 * part <= record - 4 ? d % 4 : d - (record - 4));
  }

  template <int terms, bool has_reactions>
  static void add_pairs(OuterLevel const& level, float const* target, F const (&x)[3], F const (&strength)[n_strength], F (&u)[3], F (&v)[3]) {
    F const r[3] = {target[0] - x[0], target[1] - x[1], target[2] - x[2]};
    F const r2 = r[0] * r[0] + r[1] * r[1] + r[2] * r[2];
    Place<float> const at(r2 * level.to_pieces + level.shift);
    F first = at.coefficient(level.first + (terms - 1) * OuterLevel::pieces), second = at.coefficient(level.second + (terms - 1) * OuterLevel::pieces);
    for (int k = terms - 2; k >= 0; --k) {
      first = first * at.rest + at.coefficient(level.first + k * OuterLevel::pieces);
      second = second * at.rest + at.coefficient(level.second + k * OuterLevel::pieces);
    }
    auto const is_inside = less(r2, broadcast(1.0f - 1e-6f));
    first = only(is_inside, first), second = only(is_inside, second);
    Kernel::add_of(r, first, second, strength, u);
    if constexpr (has_reactions) Kernel::add_of(r, first, second, target + 3, v);
  }

  // Lane 4 j + i of v is that of source 4 i + j from `begin` on.
  void add_reactions(F const (&v)[3], int begin) {
    alignas(64) float rows[4 * W];
    for (int d = 0; d < 3; ++d) store(rows + d * W, v[d]);
    store(rows + 3 * W, F{});
    transpose_squares(rows);
    for (int i = 0; i < smaller(W, n_ - begin); ++i) {
      double* const sum = reactions_[begin + i];
      __m256d const reaction = _mm256_cvtps_pd(_mm_load_ps(rows + 4 * i)), before = _mm256_loadu_pd(sum);
      _mm256_storeu_pd(sum, Kernel::parity > 0 ? _mm256_add_pd(before, reaction) : _mm256_sub_pd(before, reaction));
    }
  }

  NearWork<double> const& work_;
  NearGroup const& group_;
  double middle_[3];
  float target_[lanes<double>][record];
  int n_ = 0;
  alignas(64) float rows_[n_column * room];  // of 16 sources the first four numbers, then the next; transposed one for all 16 after the other
  double* reactions_[room];
};

template <class Kernel, int terms>
void add_outer_terms(NearWork<double> const& work, double* velocity) {
  long source = 0, segment = 0;
  for (long g = 0; g < work.n_group; ++g) {
    NearGroup const& group = work.groups[g];
    if (segment == group.outer_end) continue;
    OuterSources<Kernel> sources(work, group);
    double sums[lanes<double>][4] = {};
    while (segment < group.outer_end) {
      NearSegment const& piece = work.outer_segments[segment];
      bool const is_one_way = piece.reaction == NearSegment::one_way;
      source = sources.append(piece, source);
      if (source == piece.end) ++segment;
      auto const goes_on = [&](NearSegment const& next) {
        return next.level == piece.level && (next.reaction == NearSegment::one_way) == is_one_way;
      };
      if (!sources.is_full() && segment < group.outer_end && goes_on(work.outer_segments[segment])) continue;
      if (is_one_way)
        sources.template add<terms, false>(work.outer_levels[piece.level], sums[0]);
      else
        sources.template add<terms, true>(work.outer_levels[piece.level], sums[0]);
    }
    for (int i = 0; i < group.n_target; ++i)
      for (int d = 0; d < 3; ++d) velocity[3 * (group.target + i) + d] += work.velocity_scale * sums[i][d];
  }
}

template <class Kernel>
void add_outer(NearWork<double> const& work, double* velocity) {
  static_assert(OuterLevel::fewest == 5 && OuterLevel::most == 7);
  if (work.outer_terms == 5) return add_outer_terms<Kernel, 5>(work, velocity);
  if (work.outer_terms == 6) return add_outer_terms<Kernel, 6>(work, velocity);
  add_outer_terms<Kernel, 7>(work, velocity);
}

#endif

}  // namespace
}  // namespace asterflow

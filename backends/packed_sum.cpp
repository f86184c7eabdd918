#include "backends/packed_sum.hpp"

#include "backends/blocks.hpp"

#include <algorithm>
#include <cmath>
#include <new>
#include <stdexcept>

namespace asterflow {
namespace {

constexpr long smallest_self_sum = 512;  // below, sharing the work both ways costs more than it saves
constexpr long groups_per_task = 8;      // of targets, in the sum one way
constexpr long most_parts = 16;          // of the sources where tasks are few,
constexpr long sources_per_part = 4096;  // with so many or more

// Where the sources appear among the targets as one run; targets.size() when they do not. A few places that
// begin like the sources are tried.
long find_run(ConstPoints sources, ConstPoints targets) {
  auto const same = [](Vec3d const& a, Vec3d const& b) { return a.x == b.x && a.y == b.y && a.z == b.z; };
  int trials = 8;
  for (std::size_t i = 0; i + sources.size() <= targets.size(); ++i) {
    if (!same(sources.front(), targets[i])) continue;
    if (std::equal(sources.begin(), sources.end(), targets.begin() + static_cast<long>(i), same)) return static_cast<long>(i);
    if (--trials == 0) break;
  }
  return static_cast<long>(targets.size());
}

// Throws std::bad_alloc where memory is missing, as everything but Kokkos does.
template <class View>
void grow(View& numbers, long n, char const* label) {
  if (static_cast<long>(numbers.extent(0)) >= n) return;
  try {
    numbers = View(Kokkos::view_alloc(std::string("asterflow::PackedSum::") + label, Kokkos::WithoutInitializing), n);
  } catch (std::runtime_error const&) {
    throw std::bad_alloc();
  }
}

}  // namespace

template <class Real>
void PackedSum<Real>::set_points(ConstPoints sources, ConstPoints targets, ConstPoints normals, Frame const& frame) {
  long const lanes = loops_.lanes, width = n_numbers();
  frame_ = frame;
  n_source_ = static_cast<long>(sources.size());
  n_target_ = static_cast<long>(targets.size());
  first_self_ = n_source_ < smallest_self_sum ? n_target_ : find_run(sources, targets);
  n_self_ = first_self_ < n_target_ ? n_source_ : 0;
  set_blocks();

  long const n_row_group = (n_source_ + lanes - 1) / lanes, n_other = n_target_ - n_self_;
  long const n_group = (n_other + lanes - 1) / lanes;
  grow(records_, (n_row_group * lanes + 1) * width, "records");
  grow(rows_, n_self_ > 0 ? n_row_group * lanes * width : 0, "rows");
  grow(row_velocity_, n_self_ > 0 ? n_row_group * lanes * 3 : 0, "row_velocity");
  grow(targets_, n_group * lanes * n_coordinates<Real>, "targets");
  long const n_task = (n_group + groups_per_task - 1) / groups_per_task;
  n_part_ = n_task > most_parts ? 1 : std::clamp(n_source_ / sources_per_part, 1L, most_parts);
  grow(target_velocity_, n_part_ * n_group * lanes * 3, "target_velocity");

  std::fill_n(&records_(n_row_group * lanes * width), width, Real(0));
  // Padding repeats the last point; as a source it has strength 0.
  for (long j = 0; j < n_row_group * lanes; ++j) {
    long const i = std::min(j, n_source_ - 1);
    put_coordinates(&records_(j * width), 1, sources[i], frame_);
    if (kernel_.has_normal) put(&records_(j * width + n_coordinates<Real> + 3), 1, normals[i]);
    if (n_self_ == 0) continue;
    Real* const row = &rows_((j / lanes) * lanes * width + j % lanes);
    put_coordinates(row, lanes, sources[i], frame_);
    if (kernel_.has_normal) put(row + (n_coordinates<Real> + 3) * lanes, lanes, normals[i]);
  }
  for (long j = 0; j < n_group * lanes; ++j) {
    long const i = std::min(j, n_other - 1);
    put_coordinates(&targets_((j / lanes) * lanes * n_coordinates<Real> + j % lanes), lanes,
                    targets[i < first_self_ ? i : i + n_self_], frame_);
  }
}

// Few rounds, since threads wait for each other after every one, and enough pairs per round to share evenly.
template <class Real>
void PackedSum<Real>::set_blocks() {
  blocks_.clear();
  if (n_self_ == 0) return;
  long const n_group = (n_self_ + loops_.lanes - 1) / loops_.lanes;
  long const n_block = n_self_ < 4096 ? 16 : 32;
  for (long b = 0; b < n_block; ++b) {
    long const first = b * n_group / n_block;
    blocks_.push_back({first, (b + 1) * n_group / n_block - first});
  }
}

template <class Real>
void PackedSum<Real>::pack_strengths(ConstPoints strengths) {
  long const lanes = loops_.lanes, width = n_numbers();
  strength_unit_ = strength_unit(strengths);
  double const scale = 1.0 / strength_unit_;
  long const n_padded = (n_source_ + lanes - 1) / lanes * lanes;
  for_blocks("PackedSum::pack_strengths", n_padded, [&](long j) {
    Vec3d const q = j < n_source_ ? scale * strengths[j] : Vec3d{};
    put(&records_(j * width + n_coordinates<Real>), 1, q);
    if (n_self_ > 0) put(&rows_((j / lanes) * lanes * width + n_coordinates<Real> * lanes + j % lanes), lanes, q);
  });
}

// Other targets from all sources, a part of them at a time where targets are few, and every block from itself.
template <class Real>
void PackedSum<Real>::sum_one_way() {
  long const lanes = loops_.lanes, width = n_numbers(), stride = n_coordinates<Real> * lanes;
  long const n_group = (n_target_ - n_self_ + lanes - 1) / lanes;
  long const n_task = (n_group + groups_per_task - 1) / groups_per_task;
  parallel_for("PackedSum::sum_one_way", n_part_ * n_task + static_cast<long>(blocks_.size()), [&](long task) {
    if (task < n_part_ * n_task) {
      long const part = task / n_task, first = task % n_task * groups_per_task, n = std::min(groups_per_task, n_group - first);
      long const source = part * n_source_ / n_part_, n_source = (part + 1) * n_source_ / n_part_ - source;
      double* const velocity = target_velocity_.data() + (part * n_group + first) * 3 * lanes;
      std::fill_n(velocity, n * 3 * lanes, 0.0);
      loops_.add_one_way(&targets_(first * stride), n, stride, records_.data() + source * width, n_source, velocity);
    } else {
      Block const& block = blocks_[task - n_part_ * n_task];
      double* const velocity = &row_velocity_(block.first_group * 3 * lanes);
      std::fill_n(velocity, block.n_group * 3 * lanes, 0.0);
      loops_.add_one_way(&rows_(block.first_group * lanes * width), block.n_group, width * lanes,
                         &records_(block.first_group * lanes * width), block.n_group * lanes, velocity);
    }
  });
  for (long i = n_group * 3 * lanes; i < n_part_ * n_group * 3 * lanes; ++i) target_velocity_(i % (n_group * 3 * lanes)) += target_velocity_(i);
}

template <class Real>
void PackedSum<Real>::sum_block_pair(Block const& rows, Block const& columns) {
  long const lanes = loops_.lanes, width = n_numbers();
  long const at_once = PairSums<Real>::max_column;
  for (long j = 0; j < columns.n_group * lanes; j += at_once) {
    long const column = columns.first_group * lanes + j;
    loops_.add_both_ways(&rows_(rows.first_group * lanes * width), rows.n_group, &records_(column * width),
                         std::min(at_once, columns.n_group * lanes - j), &row_velocity_(rows.first_group * 3 * lanes),
                         &row_velocity_(column * 3));
  }
}

// Round-robin tournament: block n - 1 stays, the others rotate.
template <class Real>
void PackedSum<Real>::sum_both_ways() {
  long const n = static_cast<long>(blocks_.size());
  for (long round = 0; round < n - 1; ++round)
    parallel_for("PackedSum::sum_both_ways", n / 2, [&](long k) {
      long const a = (round + k) % (n - 1);
      long const b = k == 0 ? n - 1 : (round - k + n - 1) % (n - 1);
      sum_block_pair(blocks_[a], blocks_[b]);
    });
}

template <class Real>
void PackedSum<Real>::add_velocity(ConstPoints strengths, Points velocity) {
  if (n_source_ == 0 || n_target_ == 0) return;
  pack_strengths(strengths);
  sum_one_way();
  sum_both_ways();
  double const factor = kernel_.prefactor * strength_unit_ * std::pow(frame_.scale, kernel_.decay);
  long const lanes = loops_.lanes;
  for (long i = 0; i < n_target_; ++i) {
    bool const is_self = i >= first_self_ && i < first_self_ + n_self_;
    long const j = is_self ? i - first_self_ : (i < first_self_ ? i : i - n_self_);
    double const* const u = (is_self ? row_velocity_ : target_velocity_).data() + (j / lanes) * 3 * lanes + j % lanes;
    velocity[i] += factor * Vec3d{u[0], u[lanes], u[2 * lanes]};
  }
}

// Every group of targets from all sources; those that are sources lie in the rows.
template <class Real>
void PackedSum<Real>::add_gradient(ConstPoints strengths, Points gradient) {
  if (n_source_ == 0 || n_target_ == 0) return;
  pack_strengths(strengths);
  double const factor = kernel_.prefactor * strength_unit_ * std::pow(frame_.scale, kernel_.decay + 1);
  long const lanes = loops_.lanes, width = n_numbers();
  auto const sum = [&](Real const* groups, long stride, long n, auto const& target) {
    parallel_for("PackedSum::add_gradient", (n + lanes - 1) / lanes, [&](long g) {
      std::vector<double> slopes(9 * lanes, 0.0);
      loops_.add_gradient(groups + g * stride, 1, stride, records_.data(), n_source_, slopes.data());
      for (long i = g * lanes; i < std::min(n, (g + 1) * lanes); ++i)
        for (long k = 0; k < 9; ++k) gradient[3 * target(i) + k / 3][k % 3] += factor * slopes[k * lanes + i % lanes];
    });
  };
  sum(rows_.data(), width * lanes, n_self_, [&](long i) { return first_self_ + i; });
  sum(targets_.data(), n_coordinates<Real> * lanes, n_target_ - n_self_,
      [&](long i) { return i < first_self_ ? i : i + n_self_; });
}

template <class Real>
std::size_t PackedSum<Real>::memory() const {
  return sizeof(Real) * (records_.size() + rows_.size() + targets_.size()) +
         sizeof(double) * (row_velocity_.size() + target_velocity_.size()) + sizeof(Block) * blocks_.size();
}

template class PackedSum<float>;
template class PackedSum<double>;

}  // namespace asterflow

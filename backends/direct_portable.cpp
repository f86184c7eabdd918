// Direct sums in any Kokkos execution space. Each thread keeps a few targets in registers; the sources pass
// in tiles through the scratch memory of a team. Float arithmetic where the accuracy asked for and the
// points allow it.

#include "backends/backend.hpp"
#include "backends/default_space.hpp"
#include "backends/direct_any_reach.hpp"
#include "backends/frame.hpp"
#include "base/error.hpp"
#include "kernels/dual.hpp"
#include "kernels/list.hpp"

#include <Kokkos_Core.hpp>

#include <optional>

namespace asterflow {
namespace {

using Space = Kokkos::DefaultExecutionSpace;
using TeamPolicy = Kokkos::TeamPolicy<Space>;
using Team = TeamPolicy::member_type;

constexpr int threads_per_team = default_space_is_host ? 1 : 128;
constexpr int targets_per_thread = default_space_is_host ? 16 : 2;
constexpr int sources_per_tile = 128;  // summed in Real before they are added in double

template <class Real>
struct Coordinates {
  Vec3<Real> high{}, low{};

  KOKKOS_INLINE_FUNCTION static Coordinates at(Real const* a) {
    Coordinates x{{a[0], a[1], a[2]}, {}};
    if constexpr (n_coordinates<Real> == 6) x.low = {a[3], a[4], a[5]};
    return x;
  }
  friend KOKKOS_INLINE_FUNCTION Vec3<Real> operator-(Coordinates const& x, Coordinates const& y) {
    return (x.high - y.high) + (x.low - y.low);
  }
};

template <PairKernel Kernel, class Real>
class PortableSum {
  static constexpr int width = n_coordinates<Real> + (Kernel::has_normal ? 6 : 3);

  template <class Number>
  using Numbers = Kokkos::View<Number*, Space>;

 public:
  void set_points(ConstPoints sources, ConstPoints targets, ConstPoints normals, Frame const& frame) {
    frame_ = frame;
    n_source_ = static_cast<int>(sources.size());
    n_target_ = static_cast<int>(targets.size());
    grow(records_, width * n_source_, "records");
    grow(targets_, n_coordinates<Real> * n_target_, "targets");
    grow(velocity_, 3 * n_target_, "velocity");
    host_records_ = Kokkos::create_mirror_view(records_);
    host_velocity_ = Kokkos::create_mirror_view(velocity_);
    auto const host_targets = Kokkos::create_mirror_view(targets_);
    for (int j = 0; j < n_source_; ++j) {
      put_coordinates(&host_records_(j * width), 1, sources[j], frame);
      if constexpr (Kernel::has_normal) put(&host_records_(j * width + n_coordinates<Real> + 3), 1, normals[j]);
    }
    for (int i = 0; i < n_target_; ++i) put_coordinates(&host_targets(i * n_coordinates<Real>), 1, targets[i], frame);
    Kokkos::deep_copy(Space(), targets_, host_targets);
  }

  void add_velocity(ConstPoints strengths, Points velocity) {
    if (n_source_ == 0 || n_target_ == 0) return;
    double const unit = put_strengths(strengths);
    sum();
    Kokkos::deep_copy(Space(), host_velocity_, velocity_);
    Space().fence();  // the host reads the velocity
    double const factor = Kernel::prefactor * unit * std::pow(frame_.scale, Kernel::decay);
    for (int i = 0; i < n_target_; ++i)
      velocity[i] += factor * Vec3d{host_velocity_(3 * i), host_velocity_(3 * i + 1), host_velocity_(3 * i + 2)};
  }

  void add_gradient(ConstPoints strengths, Points gradient) {
    if (n_source_ == 0 || n_target_ == 0) return;
    double const factor = Kernel::prefactor * put_strengths(strengths) * std::pow(frame_.scale, Kernel::decay + 1);
    Numbers<double> slopes(Kokkos::view_alloc("asterflow::PortableSum::slopes", Kokkos::WithoutInitializing), 9 * n_target_);
    sum_slopes(slopes);
    auto const host_slopes = Kokkos::create_mirror_view(slopes);
    Kokkos::deep_copy(Space(), host_slopes, slopes);
    Space().fence();  // the host reads the gradient
    for (int k = 0; k < 9 * n_target_; ++k) gradient[k / 3][k % 3] += factor * host_slopes(k);
  }

  // slopes [n_target][3][3] = sums of the gradient of shape(), without factors.
  void sum_slopes(Numbers<double> const& slopes) const {
    auto const records = records_, targets = targets_;
    int const n_source = n_source_;
    Kokkos::parallel_for("asterflow::PortableSum::sum_slopes", Kokkos::RangePolicy<Space>(0, n_target_), KOKKOS_LAMBDA(int i) {
      using D = Dual<Real>;
      auto const x = Coordinates<Real>::at(&targets(i * n_coordinates<Real>));
      double total[9] = {0, 0, 0, 0, 0, 0, 0, 0, 0};
      for (int j = 0; j < n_source; ++j) {
        Real const* const source = &records(j * width);
        Real const* const q = source + n_coordinates<Real>;
        Vec3<Real> const r = x - Coordinates<Real>::at(source);
        Vec3<D> normal{};
        if constexpr (Kernel::has_normal) normal = {q[3], q[4], q[5]};
        Vec3<D> const u = Kernel::template shape<D>(differentiable(r), differentiable_inverse(r, inverse_distance(r)),
                                                    {q[0], q[1], q[2]}, normal);
        for (int k = 0; k < 9; ++k) total[k] += u[k / 3].slope[k % 3];
      }
      for (int k = 0; k < 9; ++k) slopes(9 * i + k) = total[k];
    });
  }

  // velocity_ = sums of shape(), without factors.
  void sum() {
    auto const records = records_, targets = targets_;
    auto const velocity = velocity_;
    int const n_source = n_source_, n_target = n_target_;
    constexpr int targets_per_team = threads_per_team * targets_per_thread;
    using Tile = Kokkos::View<Real*, Space::scratch_memory_space, Kokkos::MemoryUnmanaged>;
    TeamPolicy policy(Space(), (n_target + targets_per_team - 1) / targets_per_team, threads_per_team);
    policy.set_scratch_size(0, Kokkos::PerTeam(Tile::shmem_size(sources_per_tile * width)));
    Kokkos::parallel_for("asterflow::PortableSum::sum", policy, KOKKOS_LAMBDA(Team const& team) {
      Tile const tile(team.team_scratch(0), sources_per_tile * width);
      int const first_target = team.league_rank() * targets_per_team + team.team_rank();
      Coordinates<Real> x[targets_per_thread];
      Vec3<double> total[targets_per_thread];
      for (int k = 0; k < targets_per_thread; ++k) {
        int const i = first_target + k * threads_per_team;
        x[k] = Coordinates<Real>::at(&targets((i < n_target ? i : n_target - 1) * n_coordinates<Real>));
      }
      for (int first = 0; first < n_source; first += sources_per_tile) {
        int const n = n_source - first < sources_per_tile ? n_source - first : sources_per_tile;
        team.team_barrier();
        Kokkos::parallel_for(Kokkos::TeamThreadRange(team, n * width), [&](int k) { tile(k) = records(first * width + k); });
        team.team_barrier();
        Vec3<Real> u[targets_per_thread];
        for (int j = 0; j < n; ++j) {
          Real const* const source = &tile(j * width);
          Real const* const q = source + n_coordinates<Real>;
          Vec3<Real> normal{};
          if constexpr (Kernel::has_normal) normal = {q[3], q[4], q[5]};
          for (int k = 0; k < targets_per_thread; ++k) {
            Vec3<Real> const r = x[k] - Coordinates<Real>::at(source);
            u[k] += Kernel::shape(r, inverse_distance(r), Vec3<Real>{q[0], q[1], q[2]}, normal);
          }
        }
        for (int k = 0; k < targets_per_thread; ++k) total[k] += Vec3<double>{u[k].x, u[k].y, u[k].z};
      }
      for (int k = 0; k < targets_per_thread; ++k) {
        int const i = first_target + k * threads_per_team;
        if (i < n_target)
          for (int c = 0; c < 3; ++c) velocity(3 * i + c) = total[k][c];
      }
    });
  }

  std::size_t memory() const {
    return sizeof(Real) * (records_.size() + targets_.size()) + sizeof(double) * velocity_.size();
  }

  // Sends the strengths in units of the number returned.
  double put_strengths(ConstPoints strengths) {
    double const unit = strength_unit(strengths);
    for (int j = 0; j < n_source_; ++j)
      put(&host_records_(j * width + n_coordinates<Real>), 1, (1.0 / unit) * strengths[j]);
    Kokkos::deep_copy(Space(), records_, host_records_);
    return unit;
  }

 private:
  template <class View>
  static void grow(View& numbers, std::size_t n, char const* label) {
    if (numbers.extent(0) < n)
      numbers = View(Kokkos::view_alloc(std::string("asterflow::PortableSum::") + label, Kokkos::WithoutInitializing), n);
  }

  Frame frame_;
  int n_source_ = 0, n_target_ = 0;
  Numbers<Real> records_;     // [n_source][width]  coordinates, strength, normal
  Numbers<Real> targets_;     // [n_target][n_coordinates]
  Numbers<double> velocity_;  // [n_target][3]
  typename Numbers<Real>::HostMirror host_records_;
  typename Numbers<double>::HostMirror host_velocity_;
};

template <PairKernel Kernel>
class DirectPortable final : public Evaluator {
 public:
  explicit DirectPortable(EvaluatorOptions const& options)
      : may_use_float_(options.accuracy >= (options.gradient ? 2.0 : 1.0) * float_rounding) {}

  void set_points(ConstPoints sources, ConstPoints targets, ConstPoints normals) override {
    ASTERFLOW_REQUIRE(normals.size() == (Kernel::has_normal ? sources.size() : 0));
    Bounds const box = bounding_box(sources, targets);
    n_source_ = sources.size();
    n_target_ = targets.size();
    uses_float_ = may_use_float_ && !is_too_close_for_float(sources, targets, box);
    if (uses_float_)
      in_float_.set_points(sources, targets, normals, frame_of<float>(box));
    else
      in_double_.set_points(sources, targets, normals, frame_of<double>(box));
  }

  void add_velocity(ConstPoints strengths, Points velocity) override {
    ASTERFLOW_REQUIRE(strengths.size() == n_source_ && velocity.size() == n_target_);
    if (uses_float_)
      in_float_.add_velocity(strengths, velocity);
    else
      in_double_.add_velocity(strengths, velocity);
  }

  void add_gradient(ConstPoints strengths, Points gradient) override {
    ASTERFLOW_REQUIRE(strengths.size() == n_source_ && gradient.size() == 3 * n_target_);
    if (uses_float_)
      in_float_.add_gradient(strengths, gradient);
    else
      in_double_.add_gradient(strengths, gradient);
  }

  std::string_view backend() const override { return "direct-portable"; }
  std::size_t memory() const override { return in_float_.memory() + in_double_.memory(); }

 private:
  bool may_use_float_, uses_float_ = false;
  std::size_t n_source_ = 0, n_target_ = 0;
  PortableSum<Kernel, float> in_float_;
  PortableSum<Kernel, double> in_double_;
};

}  // namespace

std::unique_ptr<Evaluator> make_direct_portable(std::string_view kernel, EvaluatorOptions const& options) {
  std::unique_ptr<Evaluator> evaluator;
  with_kernel(kernel, [&](auto k) { evaluator = std::make_unique<DirectPortable<decltype(k)>>(options); });
  return for_any_reach(kernel, std::move(evaluator));
}

}  // namespace asterflow

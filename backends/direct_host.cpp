// Direct sums on host threads with the explicit-SIMD pair loops of one instruction set.

#include "backends/backend.hpp"
#include "backends/direct_any_reach.hpp"
#include "backends/packed_sum.hpp"
#include "base/error.hpp"
#include "kernels/list.hpp"

#include <optional>

namespace asterflow {
namespace {

enum class InstructionSet { avx2, avx512 };

// A relative error of 1 / |r| grows at most fivefold in a kernel (stresslet: fifth power).
constexpr double error_growth = 5.0;

template <class Real>
PairSums<Real> find_loops(InstructionSet instructions, int i_kernel, int steps) {
#ifdef ASTERFLOW_HAS_X86_SIMD
  return instructions == InstructionSet::avx512 ? avx512_pair_sums<Real>(i_kernel, steps)
                                                : avx2_pair_sums<Real>(i_kernel, steps);
#else
  (void)instructions, (void)i_kernel, (void)steps;
  return {};
#endif
}

// The loops with the fewest correction steps that keep the error of one pair, relative to that pair's
// velocity, within `accuracy`; without functions when this arithmetic cannot.
template <class Real>
PairSums<Real> loops_for(InstructionSet instructions, int i_kernel, double accuracy) {
  double const rounding = sizeof(Real) == 4 ? float_rounding : 0.0;
  PairSums<Real> loops;
  for (int steps = 0;; ++steps) {
    PairSums<Real> const candidate = find_loops<Real>(instructions, i_kernel, steps);
    if (!candidate.add_one_way) return loops;
    if (error_growth * candidate.error + rounding <= accuracy) return candidate;
  }
}

KernelTraits traits_of(std::string_view name) {
  KernelTraits traits;
  int i = 0;
  std::apply(
      [&](auto... k) {
        ((k.name == name ? void(traits = {i++, k.prefactor, k.decay, k.has_normal}) : void(i++)), ...);
      },
      AllSums{});
  return traits;
}

// Float arithmetic where the accuracy asked for and the points allow it, else double.
class DirectHost final : public Evaluator {
 public:
  DirectHost(InstructionSet instructions, std::string_view name, double accuracy)
      : instructions_(instructions),
        kernel_(traits_of(name)),
        accuracy_(accuracy),
        in_double_(kernel_, loops_for<double>(instructions, kernel_.index, accuracy)) {
    auto const loops = loops_for<float>(instructions, kernel_.index, accuracy);
    if (loops.add_one_way) in_float_.emplace(kernel_, loops);
  }

  void set_points(ConstPoints sources, ConstPoints targets, ConstPoints normals) override {
    ASTERFLOW_REQUIRE(normals.size() == (kernel_.has_normal ? sources.size() : 0));
    Bounds const box = bounding_box(sources, targets);
    n_source_ = sources.size();
    n_target_ = targets.size();
    uses_float_ = in_float_ && !may_cancel() && !is_too_close_for_float(sources, targets, box);
    if (uses_float_)
      in_float_->set_points(sources, targets, normals, frame_of<float>(box));
    else
      in_double_.set_points(sources, targets, normals, frame_of<double>(box));
  }

  void add_velocity(ConstPoints strengths, Points velocity) override {
    ASTERFLOW_REQUIRE(strengths.size() == n_source_ && velocity.size() == n_target_);
    if (uses_float_)
      in_float_->add_velocity(strengths, velocity);
    else
      in_double_.add_velocity(strengths, velocity);
  }

  void add_gradient(ConstPoints strengths, Points gradient) override {
    ASTERFLOW_REQUIRE(strengths.size() == n_source_ && gradient.size() == 3 * n_target_);
    if (uses_float_)
      in_float_->add_gradient(strengths, gradient);
    else
      in_double_.add_gradient(strengths, gradient);
  }

  std::string_view backend() const override {
    return instructions_ == InstructionSet::avx512 ? "direct-avx512" : "direct-avx2";
  }

  std::size_t memory() const override { return in_double_.memory() + (in_float_ ? in_float_->memory() : 0); }

 private:
  // At few targets velocities may all be small by chance, and what float leaves be too much of them.
  bool may_cancel() const {
    constexpr std::size_t few = 32;
    return n_target_ < few && accuracy_ < 10.0 * float_rounding;
  }

  InstructionSet instructions_;
  KernelTraits kernel_;
  double accuracy_;
  PackedSum<double> in_double_;
  std::optional<PackedSum<float>> in_float_;
  bool uses_float_ = false;
  std::size_t n_source_ = 0, n_target_ = 0;
};

// A gradient has one more factor 1 / |r|, at most.
double pair_accuracy(EvaluatorOptions const& options) { return options.gradient ? 0.5 * options.accuracy : options.accuracy; }

}  // namespace

std::unique_ptr<Evaluator> make_direct_avx2(std::string_view kernel, EvaluatorOptions const& options) {
  return for_any_reach(kernel, std::make_unique<DirectHost>(InstructionSet::avx2, kernel, pair_accuracy(options)));
}

std::unique_ptr<Evaluator> make_direct_avx512(std::string_view kernel, EvaluatorOptions const& options) {
  return for_any_reach(kernel, std::make_unique<DirectHost>(InstructionSet::avx512, kernel, pair_accuracy(options)));
}

PairArithmetic pair_arithmetic(std::string_view instructions, std::string_view kernel, double accuracy) {
  InstructionSet const set = instructions == "avx512" ? InstructionSet::avx512 : InstructionSet::avx2;
  auto const single = loops_for<float>(set, traits_of(kernel).index, accuracy);
  if (single.add_one_way) return {32, single.steps, single.lanes, single.error};
  auto const full = loops_for<double>(set, traits_of(kernel).index, accuracy);
  return {64, full.steps, full.lanes, full.error};
}

}  // namespace asterflow

// The fast backends: fast sums whose error is checked on a few targets at every sum. Parameters are chosen for the
// error that strengths of random direction leave; where the velocities at the targets cancel, or all targets
// are far from the sources, the same absolute error may be too large. Then a stricter sum takes over.

#include "backends/backend.hpp"
#include "backends/fast.hpp"
#include "base/error.hpp"

#include <algorithm>
#include <cmath>

namespace asterflow {
namespace {

constexpr double strictest = 1e-12;   // fast sums cannot do better
constexpr std::size_t n_checked = 16;  // targets
constexpr double tolerated = 2.0;      // estimated error over the one asked for: the estimate is a sample's
constexpr double margin = 0.3;         // of the next accuracy, where one was missed

double square(ConstPoints points) {
  double sum = 0.0;
  for (Vec3d const& p : points) sum += dot(p, p);
  return sum;
}

class CheckedFast final : public Evaluator {
 public:
  CheckedFast(std::string_view kernel, EvaluatorOptions const& options, FastInstructions instructions, std::string_view name)
      : kernel_(kernel), options_(options), instructions_(instructions), name_(name) {}

  void set_points(ConstPoints sources, ConstPoints targets, ConstPoints normals) override {
    if (!first_) first_ = make_sum(options_.accuracy);
    first_->set_points(sources, targets, normals);
    stricter_.reset();
    accuracy_ = options_.accuracy;
    is_self_ = sources.data() == targets.data() && sources.size() == targets.size();
    sources_.assign(sources.begin(), sources.end());
    targets_.assign(targets.begin(), is_self_ ? targets.begin() : targets.end());
    normals_.assign(normals.begin(), normals.end());
    choose_checked();
  }

  void add_velocity(ConstPoints strengths, Points velocity) override {
    PointArray sum(velocity.size());
    used().add_velocity(strengths, sum);
    for (double missed = excess(strengths, sum); missed > tolerated; missed = excess(strengths, sum)) {
      if (accuracy_ < strictest) break;  // direct sums
      tighten(missed);
      std::fill(sum.begin(), sum.end(), Vec3d{});
      used().add_velocity(strengths, sum);
    }
    for (std::size_t i = 0; i < sum.size(); ++i) velocity[i] += sum[i];
  }

  void add_gradient(ConstPoints strengths, Points gradient) override { used().add_gradient(strengths, gradient); }

  std::string_view backend() const override { return name_; }
  std::size_t memory() const override {
    std::size_t bytes = sizeof(Vec3d) * (sources_.capacity() + targets_.capacity() + normals_.capacity());
    for (Evaluator const* part : {first_.get(), stricter_.get(), exact_.get()}) bytes += part ? part->memory() : 0;
    return bytes;
  }

 private:
  Evaluator& used() { return stricter_ ? *stricter_ : *first_; }
  ConstPoints targets() const { return is_self_ ? ConstPoints(sources_) : ConstPoints(targets_); }

  std::unique_ptr<Evaluator> make_sum(double accuracy) const {
    if (accuracy < strictest) return make_direct(kernel_, {.accuracy = accuracy, .gradient = options_.gradient});
    return make_fast(kernel_, fast_parameters(kernel_, accuracy, options_.gradient), instructions_, name_);
  }

  // Every n-th target in their own order, all where there are few.
  void choose_checked() {
    checked_.clear();
    exact_.reset();
    std::size_t const n = targets().size();
    if (accuracy_ < strictest || n == 0 || sources_.empty()) return;
    PointArray some;
    for (std::size_t k = 0; k < std::min(n, n_checked); ++k) {
      checked_.push_back(n <= n_checked ? k : (2 * k + 1) * n / (2 * n_checked));
      some.push_back(targets()[checked_.back()]);
    }
    exact_ = make_direct(kernel_, {.accuracy = std::min(1e-8, 0.01 * accuracy_)});
    exact_->set_points(sources_, some, normals_);
  }

  // Estimated error over the error asked for.
  double excess(ConstPoints strengths, ConstPoints velocity) {
    if (!exact_) return 0.0;
    PointArray difference(checked_.size());
    exact_->add_velocity(strengths, difference);
    for (std::size_t k = 0; k < checked_.size(); ++k) difference[k] -= velocity[checked_[k]];
    double const size = square(velocity);
    if (size == 0.0) return square(difference) > 0.0 ? 1.0 / options_.accuracy : 0.0;
    double const share = static_cast<double>(checked_.size()) / static_cast<double>(velocity.size());
    return std::sqrt(square(difference) / (share * size)) / options_.accuracy;
  }

  void tighten(double missed) {
    accuracy_ *= std::max(margin / missed, 1e-6);
    if (accuracy_ < strictest) accuracy_ = accuracy_ > 0.01 * strictest && !is_strictest_ ? strictest : 1e-15;
    is_strictest_ = accuracy_ == strictest;
    stricter_ = make_sum(accuracy_);
    stricter_->set_points(sources_, targets(), normals_);
  }

  std::string kernel_;
  EvaluatorOptions options_;
  FastInstructions instructions_;
  std::string_view name_;
  double accuracy_ = 0.0;  // of the sum in use
  bool is_strictest_ = false;
  bool is_self_ = false;   // targets are the sources
  PointArray sources_, targets_, normals_;
  std::vector<std::size_t> checked_;
  std::unique_ptr<Evaluator> first_, stricter_;  // stricter_: in place of first_ where that was not enough
  std::unique_ptr<Evaluator> exact_;             // at the checked targets
};

template <FastInstructions instructions>
std::unique_ptr<Evaluator> make(std::string_view kernel, EvaluatorOptions const& options, std::string_view name) {
  if (options.accuracy < strictest) return make_direct(kernel, options);
  return std::make_unique<CheckedFast>(kernel, options, instructions, name);
}

}  // namespace

std::unique_ptr<Evaluator> make_fast_portable(std::string_view kernel, EvaluatorOptions const& options) {
  return make<FastInstructions::portable>(kernel, options, "fast-portable");
}

std::unique_ptr<Evaluator> make_fast_avx2(std::string_view kernel, EvaluatorOptions const& options) {
  return make<FastInstructions::avx2>(kernel, options, "fast-avx2");
}

std::unique_ptr<Evaluator> make_fast_avx512(std::string_view kernel, EvaluatorOptions const& options) {
  return make<FastInstructions::avx512>(kernel, options, "fast-avx512");
}

std::unique_ptr<Evaluator> make_fast(std::string_view kernel, EvaluatorOptions const& options) {
  if (has_avx512()) return make<FastInstructions::avx512>(kernel, options, "fast");
  if (has_avx2()) return make<FastInstructions::avx2>(kernel, options, "fast");
  return make<FastInstructions::portable>(kernel, options, "fast");
}

}  // namespace asterflow

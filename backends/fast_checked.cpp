// The fast backends: fast sums whose error is checked on a few targets at every sum. Parameters are chosen for the
// error that strengths of random direction leave; where the velocities at the targets cancel, or all targets
// are far from the sources, the same absolute error may be too large. Then a stricter sum takes over. The
// error may be that of the few targets next to the sources, where results are large: half of those checked are the
// largest and some of the eighth of largest results of the first sum. Without the largest the error is not to be too large either.

#include "backends/backend.hpp"
#include "backends/blocks.hpp"
#include "backends/default_space.hpp"
#include "backends/fast.hpp"
#include "base/error.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

namespace asterflow {
namespace {

constexpr double strictest = 1e-12;   // fast sums cannot do better
constexpr std::size_t n_checked = 96;  // targets,
constexpr std::size_t n_largest = 16;  // all of the largest results among them
constexpr double roughly_checked = 1e-5;  // coarser ones are compared with direct sums in float
constexpr double least_others = 0.06;   // of the squares of all results, taken for those that are not the largest
constexpr double margin = 0.3;         // of the next accuracy, where one was missed

// By blocks, the same bits for any number of threads.
double square(ConstPoints points) {
  constexpr long block = 4096;
  long const n = static_cast<long>(points.size());
  std::vector<double> sums((n + block - 1) / block, 0.0);
  parallel_for("Fast::square", static_cast<long>(sums.size()), [&](long k) {
    double sum = 0.0;
    for (long i = k * block; i < std::min(n, (k + 1) * block); ++i) sum += dot(points[i], points[i]);
    sums[k] = sum;
  });
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

class CheckedFast final : public FastEvaluator {
 public:
  CheckedFast(std::string_view kernel, EvaluatorOptions const& options, FastInstructions instructions, std::string_view name)
      : kernel_(kernel), options_(options), instructions_(instructions), name_(name), first_(make_sum(options.accuracy)) {}

  Plan plan(ConstPoints sources, ConstPoints targets) const override { return first_->plan(sources, targets); }

  void set_planned_points(ConstPoints sources, ConstPoints targets, ConstPoints normals, Plan const& plan) override {
    first_->set_planned_points(sources, targets, normals, plan);
    stricter_.reset();
    accuracy_ = options_.accuracy;
    is_strictest_ = accuracy_ == strictest;
    is_self_ = is_same(sources, targets);
    sources_.assign(sources.begin(), sources.end());
    targets_.assign(targets.begin(), is_self_ ? targets.begin() : targets.end());
    normals_.assign(normals.begin(), normals.end());
    checked_.clear();
    exact_.reset();
  }

  void add_velocity(ConstPoints strengths, Points velocity) override {
    add_checked(&Evaluator::add_velocity, 1, strengths, velocity);
  }
  void add_gradient(ConstPoints strengths, Points gradient) override {
    add_checked(&Evaluator::add_gradient, 3, strengths, gradient);
  }

  std::string_view backend() const override { return name_; }
  std::size_t memory() const override {
    std::size_t bytes = sizeof(Vec3d) * (sources_.capacity() + targets_.capacity() + normals_.capacity() + sum_.capacity());
    for (Evaluator const* part : {stricter_.get(), exact_.get()}) bytes += part ? part->memory() : 0;
    return bytes + first_->memory();
  }

 private:
  struct Checked {
    std::size_t target;
    double stands_for;  // so many targets
    bool is_largest;    // one of n_largest
  };
  using Add = void (Evaluator::*)(ConstPoints strengths, Points result);

  // Stricter until the error at the checked targets is what was asked for. `rows` points of the result per target. Where exact
  // sums in float say that it is not, they are done in double first: they may be what is wrong.
  void add_checked(Add add, std::size_t rows, ConstPoints strengths, Points result) {
    PointArray& sum = sum_;
    sum.resize(result.size());
    auto const clear = [&] { for_blocks("Fast::clear", static_cast<long>(sum.size()), [&](long i) { sum[i] = {}; }); };
    clear();
    (used().*add)(strengths, sum);
    for (double missed = excess(add, rows, strengths, sum); missed > options_.largest_excess; missed = excess(add, rows, strengths, sum)) {
      if (is_rough_) {
        is_rough_ = false;
        make_exact(fine_accuracy());
        continue;
      }
      if (accuracy_ < strictest) break;  // direct sums
      tighten(missed);
      clear();
      (used().*add)(strengths, sum);
    }
    for_blocks("Fast::add", static_cast<long>(sum.size()), [&](long i) { result[i] += sum[i]; });
  }

  Evaluator& used() { return stricter_ ? *stricter_ : *first_; }
  ConstPoints targets() const { return is_self_ ? ConstPoints(sources_) : ConstPoints(targets_); }

  std::unique_ptr<FastEvaluator> make_sum(double accuracy) const {
    return make_fast(kernel_, fast_parameters(kernel_, accuracy, options_.gradient), instructions_, name_);
  }

  // Evenly in their own order, all where there are few.
  void choose_checked(std::size_t rows, ConstPoints result) {
    std::vector<double> sizes(targets().size());
    for (std::size_t i = 0; i < sizes.size(); ++i)
      for (Vec3d const& row : result.subspan(rows * i, rows)) sizes[i] += dot(row, row);
    std::vector<double> sorted = sizes;
    std::size_t const n_large = std::max(n_largest, sizes.size() / 8);
    std::vector<std::size_t> groups[3];  // largest, large, others
    if (n_large < sizes.size()) {
      auto const first = sorted.begin(), large = first + static_cast<long>(n_large), largest = first + static_cast<long>(n_largest);
      std::nth_element(first, large, sorted.end(), std::greater<>());
      std::nth_element(first, largest, large + 1, std::greater<>());
      for (std::size_t i = 0; i < sizes.size(); ++i) groups[sizes[i] > *largest ? 0 : sizes[i] > *large ? 1 : 2].push_back(i);
    } else {
      for (std::size_t i = 0; i < sizes.size(); ++i) groups[2].push_back(i);
    }
    std::size_t const most[3] = {n_largest, n_checked / 2 - n_largest, n_checked / 2};
    for (int g = 0; g < 3; ++g) {
      std::size_t const size = groups[g].size(), n = std::min(size, most[g]);
      for (std::size_t k = 0; k < n; ++k)
        checked_.push_back({groups[g][(2 * k + 1) * size / (2 * n)], static_cast<double>(size) / static_cast<double>(n), g == 0});
    }
    is_rough_ = options_.accuracy >= roughly_checked;
    make_exact(is_rough_ ? 0.1 * options_.accuracy : fine_accuracy());
  }

  double fine_accuracy() const { return std::min(1e-8, 0.01 * options_.accuracy); }

  void make_exact(double accuracy) {
    PointArray some;
    for (Checked const& checked : checked_) some.push_back(targets()[checked.target]);
    exact_ = make_direct(kernel_, {.accuracy = accuracy, .gradient = options_.gradient});
    exact_->set_points(sources_, some, normals_);
  }

  // Estimated error over the error asked for: of all results or, where that is more, of those that are not among the largest.
  double excess(Add add, std::size_t rows, ConstPoints strengths, ConstPoints result) {
    if (result.empty() || sources_.empty()) return 0.0;
    if (!exact_) choose_checked(rows, result);
    PointArray exact(rows * checked_.size());
    (exact_.get()->*add)(strengths, exact);
    double error = 0.0, others_error = 0.0, others_size = 0.0;
    for (std::size_t k = 0; k < exact.size(); ++k) {
      Checked const& checked = checked_[k / rows];
      Vec3d const difference = exact[k] - result[rows * checked.target + k % rows];
      error += checked.stands_for * dot(difference, difference);
      if (checked.is_largest) continue;
      others_error += checked.stands_for * dot(difference, difference);
      others_size += checked.stands_for * dot(exact[k], exact[k]);
    }
    double const size = square(result);
    if (!std::isfinite(size)) return std::numeric_limits<double>::max();  // distances whose powers overflow
    auto const relative = [](double e, double s) { return s > 0.0 ? std::sqrt(e / s) : e > 0.0 ? 1.0 : 0.0; };
    return std::max(relative(error, size), relative(others_error, std::clamp(others_size, least_others * size, size))) / options_.accuracy;
  }

  void tighten(double missed) {
    accuracy_ *= std::max(margin / missed, 1e-6);
    if (accuracy_ < strictest) accuracy_ = accuracy_ > 0.01 * strictest && !is_strictest_ ? strictest : 1e-15;
    is_strictest_ = accuracy_ == strictest;
    if (accuracy_ < strictest)
      stricter_ = make_direct(kernel_, {.accuracy = accuracy_, .gradient = options_.gradient});
    else
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
  PointArray sum_;  // of the last strengths
  std::vector<Checked> checked_;
  std::unique_ptr<FastEvaluator> first_;
  std::unique_ptr<Evaluator> stricter_;  // in place of first_ where that was not enough
  std::unique_ptr<Evaluator> exact_;     // at the checked targets
  bool is_rough_ = false;                // exact_ sums in float
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

std::unique_ptr<Evaluator> make_fast_device(std::string_view kernel, EvaluatorOptions const& options) {
  return make<FastInstructions::device>(kernel, options, "fast-device");
}

std::unique_ptr<Evaluator> make_fast(std::string_view kernel, EvaluatorOptions const& options) {
  if (options.accuracy < strictest) return make_direct(kernel, options);
  return make_checked_fast(kernel, options);
}

std::unique_ptr<FastEvaluator> make_checked_fast(std::string_view kernel, EvaluatorOptions const& options) {
  FastInstructions const best = !default_space_is_host ? FastInstructions::device
                                : has_avx512()         ? FastInstructions::avx512
                                : has_avx2()           ? FastInstructions::avx2
                                                       : FastInstructions::portable;
  return std::make_unique<CheckedFast>(kernel, options, best, "fast");
}

}  // namespace asterflow

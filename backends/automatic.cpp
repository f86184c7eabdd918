// "auto": direct or fast sums, whichever is predicted to be cheaper for the points at hand. Direct sums cost a
// time per pair, fast ones what the plan of their octree predicts, both at the rates of rates.hpp.

#include "backends/backend.hpp"
#include "backends/fast.hpp"
#include "backends/frame.hpp"
#include "backends/rates.hpp"

#include <cmath>
#include <optional>

namespace asterflow {
namespace {

// Direct sums share some of the work between the two directions of a pair where sources are targets.
constexpr double separate_points = 1.33;

// Direct sums are in float from this accuracy on, unless points are too close for that: then in double, whose registers
// hold half as many pairs.
constexpr double in_float = 1e-6, in_double = 2.0;

// Points below which fast sums are direct ones, and factor below the crossover of a uniform cloud where no plan
// is needed to see that direct sums are cheaper.
constexpr double fewest = 1000.0, clear = 4.0;

class Automatic final : public Evaluator {
 public:
  Automatic(std::string_view kernel, EvaluatorOptions const& options) : kernel_(kernel), options_(options) {}

  void set_points(ConstPoints sources, ConstPoints targets, ConstPoints normals) override {
    if (auto const plan = cheaper_plan(sources, targets)) {
      fast_->set_planned_points(sources, targets, normals, *plan);
      used_ = fast_.get();
    } else {
      if (!direct_) direct_ = make_direct(kernel_, options_);
      direct_->set_points(sources, targets, normals);
      used_ = direct_.get();
    }
  }
  void add_velocity(ConstPoints strengths, Points velocity) override {
    if (used_) used_->add_velocity(strengths, velocity);
  }
  void add_gradient(ConstPoints strengths, Points gradient) override {
    if (used_) used_->add_gradient(strengths, gradient);
  }
  std::string_view backend() const override { return used_ ? used_->backend() : "auto"; }
  std::size_t memory() const override {
    return (direct_ ? direct_->memory() : 0) + (fast_ ? fast_->memory() : 0);
  }

 private:
  // Of fast sums, where they cost less than direct ones.
  std::optional<Plan> cheaper_plan(ConstPoints sources, ConstPoints targets) {
    bool const same = is_same(sources, targets);
    double const n_source = static_cast<double>(sources.size()), n_target = static_cast<double>(targets.size());
    double const n = 0.5 * (n_source + n_target);
    if (n < fewest || options_.accuracy < 1e-12) return {};
    if (!rates_) rates_ = sum_rates(kernel_, options_.accuracy);
    double const direct = n_source * n_target * (same ? 1.0 : separate_points) * rates_->pair / rates_->plan;
    double const digits = -std::log10(options_.accuracy);
    double const usual = n * (90.0 * digits * digits + 400.0);  // ns, of a uniform cloud
    if (direct * clear < usual) return {};
    if (!fast_) fast_ = make_checked_fast(kernel_, options_);
    Plan const plan = fast_->plan(sources, targets);
    double const fast = predicted_fast(plan.cost, n);
    if (direct > fast || (in_double * direct > fast && needs_double(sources, targets))) return plan;
    return {};
  }

  bool needs_double(ConstPoints sources, ConstPoints targets) const {
    return options_.accuracy >= in_float && is_too_close_for_float(sources, targets, bounding_box(sources, targets));
  }

  std::string kernel_;
  EvaluatorOptions options_;
  std::optional<SumRates> rates_;  // of the first points whose choice needs them
  std::unique_ptr<Evaluator> direct_;
  std::unique_ptr<FastEvaluator> fast_;
  Evaluator* used_ = nullptr;
};

}  // namespace

std::unique_ptr<Evaluator> make_automatic(std::string_view kernel, EvaluatorOptions const& options) {
  return std::make_unique<Automatic>(kernel, options);
}

}  // namespace asterflow

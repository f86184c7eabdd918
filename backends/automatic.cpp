// "auto": direct or fast sums, whichever is predicted to be cheaper for the points at hand. Direct sums cost a
// time per pair, fast ones what the plan of their octree predicts; both were measured in one run (bench_kernels,
// bench_evaluators) and depend alike on the machine, since both use its full vectors. A table rather than a
// timing: the same points give the same choice, hence the same bits, wherever and whenever.

#include "backends/backend.hpp"
#include "backends/fast_kernel.hpp"
#include "backends/fast_plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace asterflow {
namespace {

// Nanoseconds of a pair on one core where targets are sources, at 3, 6, 9 and 12 digits; linear between. A pressure
// is taken for as dear as its flow.
struct PairCosts {
  std::string_view kernel;
  std::array<double, 4> self;
};
constexpr std::array pair_costs{PairCosts{"stokeslet", {0.245, 0.28, 0.52, 0.54}},
                                PairCosts{"stresslet", {0.28, 0.315, 0.60, 0.61}},
                                PairCosts{"rotlet", {0.23, 0.27, 0.50, 0.51}}};

// Direct sums share some of the work between the two directions of a pair where sources are targets.
constexpr double separate_points = 1.33;

// What a fast sum costs besides its plan's prediction, per point: sorting and checking.
constexpr double fast_point = 150.0;  // ns

// Plans foretell too little where many digits make grids and lists outgrow the caches: this much at nine digits,
// less below, nothing at six.
constexpr double underestimate = 0.2;

// Points below which fast sums are direct ones, and factor beyond the crossover of a uniform cloud where no plan
// is needed to see which is cheaper.
constexpr double fewest = 1000.0, clear = 4.0;

double pair_cost(std::string_view kernel, double accuracy) {
  double const place = std::clamp(-std::log10(accuracy) / 3.0 - 1.0, 0.0, 2.999);
  int const i = static_cast<int>(place);
  for (PairCosts const& costs : pair_costs)
    if (kernel.starts_with(costs.kernel)) return costs.self[i] + (place - i) * (costs.self[i + 1] - costs.self[i]);
  return pair_costs[0].self[i];
}

class Automatic final : public Evaluator {
 public:
  Automatic(std::string_view kernel, EvaluatorOptions const& options) : kernel_(kernel), options_(options) {}

  void set_points(ConstPoints sources, ConstPoints targets, ConstPoints normals) override {
    auto& wanted = is_fast_cheaper(sources, targets) ? fast_ : direct_;
    if (!wanted) wanted = &wanted == &fast_ ? make_fast(kernel_, options_) : make_direct(kernel_, options_);
    used_ = wanted.get();
    used_->set_points(sources, targets, normals);
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
  bool is_fast_cheaper(ConstPoints sources, ConstPoints targets) const {
    if (options_.accuracy < 1e-12) return false;
    bool const same = sources.data() == targets.data() && sources.size() == targets.size();
    double const n_source = static_cast<double>(sources.size()), n_target = static_cast<double>(targets.size());
    double const n = 0.5 * (n_source + n_target);
    double const direct = n_source * n_target * pair_cost(kernel_, options_.accuracy) * (same ? 1.0 : separate_points);
    double const digits = -std::log10(options_.accuracy);
    double const usual = n * (90.0 * digits * digits + 400.0);  // ns, of a uniform cloud
    if (n < fewest || direct * clear < usual) return false;
    if (direct > clear * usual) return true;
    Plan const plan = best_plan(sources, targets, fast_parameters(kernel_, options_.accuracy, options_.gradient),
                                n_component(fast_kernel(kernel_)));
    double const dearer = 1.0 + underestimate * std::clamp(digits / 3.0 - 2.0, 0.0, 1.0);
    return direct > dearer * (plan.cost + fast_point * n);
  }

  std::string kernel_;
  EvaluatorOptions options_;
  std::unique_ptr<Evaluator> direct_, fast_;
  Evaluator* used_ = nullptr;
};

}  // namespace

std::unique_ptr<Evaluator> make_automatic(std::string_view kernel, EvaluatorOptions const& options) {
  return std::make_unique<Automatic>(kernel, options);
}

}  // namespace asterflow

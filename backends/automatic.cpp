// "auto": direct or fast sums, whichever is predicted to be cheaper for the points at hand. Direct sums cost a
// time per pair, fast ones about a time per point; their ratio, the number of points at which both take
// equally long, was measured with bench_evaluators (docs/summation.md) and depends little on the machine, since
// both use its full vectors.

#include "backends/backend.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace asterflow {
namespace {

// Points at which both take equally long, at 3, 6, 9 and 12 digits; linear between.
constexpr std::array stokeslet_crossover{5.0e3, 1.8e4, 2.4e4, 4.0e4};
constexpr double other_kernels = 1.2;  // the same for them, relative to the Stokeslet

// Direct sums share half of the work between the two directions of a pair where sources are targets.
constexpr double separate_points = 1.6;

double crossover(std::string_view kernel, double accuracy) {
  double const place = std::clamp(-std::log10(accuracy) / 3.0 - 1.0, 0.0, 2.999);
  int const i = static_cast<int>(place);
  double const n = stokeslet_crossover[i] + (place - i) * (stokeslet_crossover[i + 1] - stokeslet_crossover[i]);
  return kernel == "stokeslet" ? n : other_kernels * n;
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
    double const direct = n_source * n_target * (same ? 1.0 : separate_points);
    return direct > crossover(kernel_, options_.accuracy) * 0.5 * (n_source + n_target);
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

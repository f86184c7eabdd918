// Fast summation: adaptive multilevel Ewald sums. A kernel is a smooth part of cutoff s_0, one band-limited
// difference part per level of an octree, each handled by Fourier transforms on rectangular patches, and a
// local part below the size of the leaves. See docs/summation.md.

#include "backends/fast.hpp"

#include "backends/backend.hpp"
#include "backends/blocks.hpp"
#include "backends/fast_kernel.hpp"
#include "backends/fast_parts.hpp"
#include "backends/finite.hpp"
#include "base/error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace asterflow {
namespace {

// Of their sizes; infinite where one is not a number.
double largest_component(ConstPoints points) {
  constexpr long block = 4096;
  long const n = static_cast<long>(points.size());
  std::vector<double> of_block((n + block - 1) / block, 0.0);
  parallel_for("Fast::largest_component", static_cast<long>(of_block.size()), [&](long k) {
    double largest = 0.0;
    bool is_number = true;
    for (long i = k * block; i < std::min(n, (k + 1) * block); ++i)
      for (int d = 0; d < 3; ++d) {
        double const size = std::abs(points[i][d]);
        is_number = is_number && size == size;
        largest = std::max(largest, size);
      }
    of_block[k] = is_number ? largest : std::numeric_limits<double>::infinity();
  });
  return of_block.empty() ? 0.0 : *std::max_element(of_block.begin(), of_block.end());
}

class FastSum final : public FastEvaluator {
 public:
  FastSum(std::string_view kernel, FastParameters const& parameters, FastInstructions instructions, std::string_view name)
      : name_(name), kernel_(kernel), parameters_(parameters), instructions_(instructions) {}

  Plan plan(ConstPoints sources, ConstPoints targets) const override {
    return best_plan(kernel_, sources, targets, parameters_);
  }

  void set_planned_points(ConstPoints sources, ConstPoints targets, ConstPoints normals, Plan const& plan) override {
    ASTERFLOW_REQUIRE(normals.size() == (has_normal(fast_kernel(kernel_)) ? sources.size() : 0));
    require_finite(normals, "normal");
    n_source_ = sources.size();
    n_target_ = targets.size();
    direct_.reset();
    tree_.reset();
    if (n_source_ == 0 || n_target_ == 0) return;
    if (!is_direct(n_source_, n_target_, parameters_))
      tree_ = std::make_unique<Octree>(sources, targets, plan.octree);
    if (!tree_ || tree_->boxes().refined().empty()) {
      direct_ = make_direct(kernel_, {.accuracy = parameters_.accuracy, .gradient = parameters_.gradient});
      return direct_->set_points(sources, targets, normals);
    }
    if (!parts_) {
      auto* const make = instructions_ == FastInstructions::device ? make_device_parts : make_host_parts;
      parts_ = make(kernel_, parameters_, instructions_);
    }
    parts_->set_points(*tree_, normals);
  }

  void add_velocity(ConstPoints strengths, Points velocity) override {
    if (direct_) return direct_->add_velocity(strengths, velocity);
    ASTERFLOW_REQUIRE(velocity.size() == n_target_);
    double const scale = evaluate(strengths, {});
    if (scale == 0.0) return;
    for_blocks("Fast::add_velocity", static_cast<long>(n_target_),
               [&](long i) { velocity[tree_->target_order()[i]] += scale * sum_[i]; });
  }

  void add_gradient(ConstPoints strengths, Points gradient) override {
    ASTERFLOW_REQUIRE(parameters_.gradient && gradient.size() == 3 * n_target_);
    if (direct_) return direct_->add_gradient(strengths, gradient);
    PointArray slopes(3 * n_target_);
    double const scale = evaluate(strengths, slopes) / (tree_ ? tree_->side() : 1.0);
    if (scale == 0.0) return;
    for_blocks("Fast::add_gradient", static_cast<long>(n_target_), [&](long i) {
      for (long d = 0; d < 3; ++d) gradient[3L * tree_->target_order()[i] + d] += scale * slopes[3 * i + d];
    });
  }

  std::string_view backend() const override { return name_; }
  std::size_t memory() const override {
    if (direct_) return direct_->memory();
    if (!tree_) return 0;
    return parts_->memory() + tree_->memory() + sizeof(Vec3d) * (sorted_.capacity() + sum_.capacity());
  }

 private:
  // Overwrites sum_ with the velocity divided by the number returned, which is 0 where there is nothing to sum.
  // slopes [n_target, 3], its gradient in units of the root's side, unless empty.
  double evaluate(ConstPoints strengths, Points slopes) {
    ASTERFLOW_REQUIRE(strengths.size() == n_source_);
    double const largest = largest_component(strengths);
    if (!(largest < 1e150)) require_finite(strengths, "strength");
    if (largest == 0.0 || n_target_ == 0) return 0.0;
    sorted_.resize(n_source_);
    for_blocks("Fast::sort", static_cast<long>(n_source_),
               [&](long i) { sorted_[i] = strengths[tree_->source_order()[i]] / largest; });
    sum_.assign(n_target_, Vec3d{});
    parts_->add(sorted_, sum_, slopes);
    return largest / std::pow(tree_->side(), decay(fast_kernel(kernel_)));
  }

  std::string_view name_;
  std::string kernel_;
  FastParameters parameters_;
  FastInstructions instructions_;
  std::unique_ptr<FastParts> parts_;  // made for the first points that need them

  std::size_t n_source_ = 0, n_target_ = 0;
  std::unique_ptr<Evaluator> direct_;  // in place of everything else where the points are few
  std::unique_ptr<Octree> tree_;
  PointArray sorted_, sum_;  // strengths and velocity of the last sum, in the order of the tree
};

}  // namespace

std::unique_ptr<FastEvaluator> make_fast(std::string_view kernel, FastParameters const& parameters,
                                         FastInstructions instructions, std::string_view name) {
  return std::make_unique<FastSum>(kernel, parameters, instructions, name);
}

}  // namespace asterflow

#pragma once
// Fast summation with given parameters and loops, for tuning; the makers in backend.hpp choose them.

#include "backends/evaluator.hpp"
#include "backends/fast_parameters.hpp"
#include "backends/fast_plan.hpp"

namespace asterflow {

// Plans its octree apart from taking the points, so that a choice by the cost of the plan need not be paid for twice.
class FastEvaluator : public Evaluator {
 public:
  // See best_plan.
  virtual Plan plan(ConstPoints sources, ConstPoints targets) const = 0;
  // As set_points, with the plan of these points.
  virtual void set_planned_points(ConstPoints sources, ConstPoints targets, ConstPoints normals, Plan const& plan) = 0;

  void set_points(ConstPoints sources, ConstPoints targets, ConstPoints normals) final {
    set_planned_points(sources, targets, normals, plan(sources, targets));
  }
};

// Vector loops of the host, or Kokkos's default execution space.
enum class FastInstructions { portable, avx2, avx512, device };

// The error is what the parameters make it: nobody checks.
std::unique_ptr<FastEvaluator> make_fast(std::string_view kernel, FastParameters const& parameters,
                                         FastInstructions instructions, std::string_view name);

// The fast backend of this machine, whose error is checked; an accuracy of 1e-12 or more.
std::unique_ptr<FastEvaluator> make_checked_fast(std::string_view kernel, EvaluatorOptions const& options);

}  // namespace asterflow

#pragma once
// Sums of a pair kernel over many sources at many targets: the boundary behind which devices, precisions
// and fast algorithms live. Plan once, set the points once per geometry, evaluate once per strength vector.

#include "base/arrays.hpp"

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace asterflow {

struct EvaluatorOptions {
  std::string backend = "auto";  // see backend_names()
  double accuracy = 1e-6;        // relative L2 error asked for, 1e-3 ... 1e-15
  bool gradient = false;         // whether add_gradient() will be called, to the same accuracy
  // Estimated error over `accuracy` from which on fast sums are made stricter. A solve wants one linear operator for all its
  // vectors, those whose flows cancel too.
  double largest_excess = 0.9;  // what a sample of targets may miss, below 1
};

class Evaluator {
 public:
  virtual ~Evaluator() = default;

  // Fixes the geometry.
  //   sources [n, 3], targets [m, 3]
  //   normals [n, 3]  unit normals of the sources, for kernels that have them, else empty
  virtual void set_points(ConstPoints sources, ConstPoints targets, ConstPoints normals = {}) = 0;

  // velocity [m, 3] += sum over sources of kernel(target - source, strength), viscosity 1.
  //   strengths [n, 3]
  virtual void add_velocity(ConstPoints strengths, Points velocity) = 0;

  // gradient [m, 3, 3] += d velocity_i / d x_j at the targets, the same sum differentiated; the gradient of
  // component i at target k is point 3 k + i. Needs EvaluatorOptions::gradient.
  virtual void add_gradient(ConstPoints strengths, Points gradient) = 0;

  // The backend that does the work ("auto" answers with its choice after set_points).
  virtual std::string_view backend() const = 0;

  // Bytes held for the present points.
  virtual std::size_t memory() const = 0;
};

// Throws SceneError when the kernel or backend is unknown or the accuracy is out of range.
std::unique_ptr<Evaluator> make_evaluator(std::string_view kernel, EvaluatorOptions const& options);

// "auto" and every backend of this build.
std::vector<std::string> backend_names();

}  // namespace asterflow

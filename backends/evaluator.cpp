#include "backends/evaluator.hpp"

#include "backends/backend.hpp"
#include "base/error.hpp"
#include "kernels/list.hpp"

#include <array>
#include <cmath>

namespace asterflow {
namespace {

struct Backend {
  std::string_view name;
  std::unique_ptr<Evaluator> (*make)(std::string_view kernel, double accuracy);
};

constexpr std::array backends{
    Backend{"reference", make_reference},
};

}  // namespace

std::vector<std::string> backend_names() {
  std::vector<std::string> names{"auto"};
  for (auto const& backend : backends) names.emplace_back(backend.name);
  return names;
}

std::unique_ptr<Evaluator> make_evaluator(std::string_view kernel, EvaluatorOptions const& options) {
  if (!with_kernel(kernel, [](auto) {}))
    throw SceneError("kernel: unknown \"" + std::string(kernel) + "\" (known: " + kernel_names() + ")");
  if (!(options.accuracy >= 1e-15 && options.accuracy <= 1e-1))
    throw SceneError("accuracy: " + std::to_string(options.accuracy) + " is outside 1e-15 ... 1e-1");
  std::string known = "auto";
  for (auto const& backend : backends) {
    if (options.backend == backend.name || options.backend == "auto") return backend.make(kernel, options.accuracy);
    known += ", " + std::string(backend.name);
  }
  throw SceneError("backend: unknown \"" + options.backend + "\" (known: " + known + ")");
}

}  // namespace asterflow

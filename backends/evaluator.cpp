#include "backends/evaluator.hpp"

#include "backends/backend.hpp"
#include "base/error.hpp"
#include "kernels/list.hpp"

#include <array>
#include <cmath>
#include <sstream>

namespace asterflow {
namespace {

struct Backend {
  std::string_view name;
  Maker* make;
  bool (*is_available)();
};

bool always() { return true; }

constexpr std::array backends{
    Backend{"auto", make_automatic, always},
    Backend{"direct", make_direct, always},
    Backend{"direct-avx512", make_direct_avx512, has_avx512},
    Backend{"direct-avx2", make_direct_avx2, has_avx2},
    Backend{"direct-portable", make_direct_portable, always},
    Backend{"fast", make_fast, always},
    Backend{"fast-avx512", make_fast_avx512, has_avx512},
    Backend{"fast-avx2", make_fast_avx2, has_avx2},
    Backend{"fast-device", make_fast_device, always},
    Backend{"fast-portable", make_fast_portable, always},
    Backend{"reference", make_reference, always},
};

}  // namespace

std::vector<std::string> backend_names() {
  std::vector<std::string> names;
  for (auto const& backend : backends)
    if (backend.is_available()) names.emplace_back(backend.name);
  return names;
}

std::unique_ptr<Evaluator> make_evaluator(std::string_view kernel, EvaluatorOptions const& options) {
  if (!with_kernel(kernel, [](auto) {}))
    throw SceneError("kernel: unknown \"" + std::string(kernel) + "\" (known: " + kernel_names() + ")");
  if (!(options.accuracy >= 1e-15 && options.accuracy <= 1e-1))
    throw SceneError((std::ostringstream() << "accuracy: " << options.accuracy << " is outside 1e-15 ... 1e-1").str());
  for (auto const& backend : backends)
    if (options.backend == backend.name && backend.is_available())
      return backend.make(kernel, options);
  std::string known;
  for (auto const& name : backend_names()) known += (known.empty() ? "" : ", ") + name;
  throw SceneError("backend: unknown \"" + options.backend + "\" (known: " + known + ")");
}

}  // namespace asterflow

// Direct sums with the best means this build and this machine have.

#include "backends/backend.hpp"
#include "backends/default_space.hpp"

namespace asterflow {

std::unique_ptr<Evaluator> make_direct(std::string_view kernel, EvaluatorOptions const& options) {
  if (default_space_is_host && has_avx512()) return make_direct_avx512(kernel, options);
  if (default_space_is_host && has_avx2()) return make_direct_avx2(kernel, options);
  return make_direct_portable(kernel, options);
}

}  // namespace asterflow

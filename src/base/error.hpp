#pragma once
// The three ways to fail. Nothing between `throw` and `main` catches them; `main` turns them into
// exit codes 1 (scene or input), 2 (numerical), 3 (internal).

#include <stdexcept>
#include <string>

namespace asterflow {

// Wrong input. The message is one line: file, table, key, value, what is allowed.
struct SceneError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// A solve that did not converge or a state that left its bounds: what, iteration, residual, dt.
struct NumericalError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// A broken invariant of the program itself.
struct InternalError : std::logic_error {
  using std::logic_error::logic_error;
};

[[noreturn]] inline void fail_internally(char const* condition, char const* file, int line) {
  throw InternalError(std::string(file) + ":" + std::to_string(line) + ": violated: " + condition);
}

}  // namespace asterflow

#define ASTERFLOW_REQUIRE(condition) \
  ((condition) ? void(0) : ::asterflow::fail_internally(#condition, __FILE__, __LINE__))

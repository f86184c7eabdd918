#pragma once
// A subcommand of the program: declares its options when it is added, and when the user has chosen it leaves the
// action to take. The action reports failure by throwing one of the errors of base/error.hpp.

#include <CLI/CLI.hpp>

#include <functional>
#include <string>

namespace asterflow {

using Action = std::function<void()>;

// The end of a help text.
inline std::string examples(std::string const& lines) { return "\nExamples:\n" + lines; }

}  // namespace asterflow

#pragma once
// A subcommand of the program: declares its options when it is added, and when the user has chosen it leaves the
// action to take. The action reports failure by throwing one of the errors of base/error.hpp.

#include <CLI/CLI.hpp>

#include <functional>
#include <string>
#include <vector>

namespace asterflow {

using Action = std::function<void()>;

// The end of a help text.
inline std::string examples(std::string const& lines) { return "\nExamples:\n" + lines; }

// --set table.key=value, any number of times.
inline void add_overrides(CLI::App& command, std::vector<std::string>& overrides) {
  command
      .add_option("--set", overrides,
                  "table.key=value instead of what the scene says; [[body]] by position (body.0.radius=2) or name "
                  "(body.pnc.force=[1,0,0])")
      ->take_all()
      ->allow_extra_args(false);
}

}  // namespace asterflow

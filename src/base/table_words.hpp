#pragma once
// How messages about a scene file write its values and names.

#include <string>
#include <string_view>
#include <toml++/toml.h>
#include <vector>

namespace asterflow {

std::string in_quotes(std::string_view word);

// A value as a user would write it, shortened to fit a line.
std::string written(toml::node const& node);

// "(did you mean "radius"? known: name, radius)"
std::string known_names(std::string_view word, std::vector<std::string> const& names);

}  // namespace asterflow

#pragma once
// The folder of what is computed once and kept: ASTERFLOW_CACHE ("off": none), else XDG_CACHE_HOME/asterflow, else
// ~/.cache/asterflow.

#include <cstdlib>
#include <filesystem>
#include <string>

namespace asterflow {

// Empty: nothing is stored.
inline std::filesystem::path cache_folder() {
  auto const variable = [](char const* name) { return std::string(std::getenv(name) ? std::getenv(name) : ""); };
  if (auto const chosen = variable("ASTERFLOW_CACHE"); !chosen.empty()) return chosen == "off" ? "" : chosen;
  if (auto const cache = variable("XDG_CACHE_HOME"); !cache.empty()) return std::filesystem::path(cache) / "asterflow";
  if (auto const home = variable("HOME"); !home.empty()) return std::filesystem::path(home) / ".cache" / "asterflow";
  return {};
}

}  // namespace asterflow

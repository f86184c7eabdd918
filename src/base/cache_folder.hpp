#pragma once
// The folder of what is computed once and kept: ASTERFLOW_CACHE ("off": none), else XDG_CACHE_HOME/asterflow, else
// ~/.cache/asterflow. Files there are named by a number that stands for all that their contents depend on.

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

namespace asterflow {

// Empty: nothing is stored.
inline std::filesystem::path cache_folder() {
  auto const variable = [](char const* name) { return std::string(std::getenv(name) ? std::getenv(name) : ""); };
  if (auto const chosen = variable("ASTERFLOW_CACHE"); !chosen.empty()) return chosen == "off" ? "" : chosen;
  if (auto const cache = variable("XDG_CACHE_HOME"); !cache.empty()) return std::filesystem::path(cache) / "asterflow";
  if (auto const home = variable("HOME"); !home.empty()) return std::filesystem::path(home) / ".cache" / "asterflow";
  return {};
}

// Fowler-Noll-Vo hash.
inline std::uint64_t number_of(std::string_view text) {
  std::uint64_t number = 14695981039346656037ULL;
  for (char const c : text) number = (number ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return number;
}

}  // namespace asterflow

#include "base/table_words.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sstream>

namespace asterflow {
namespace {

// A value as a user would write it: numbers with as few digits as tell them apart.
std::string in_full(toml::node const& node) {
  if (auto const* number = node.as_floating_point()) {
    std::string const text = fmt::format("{}", number->get());
    return text.find_first_not_of("-0123456789") == std::string::npos ? text + ".0" : text;
  }
  if (auto const* array = node.as_array()) {
    std::vector<std::string> entries;
    for (toml::node const& entry : *array) entries.push_back(in_full(entry));
    return fmt::format("[{}]", fmt::join(entries, ", "));
  }
  std::ostringstream stream;
  node.visit([&](auto const& value) {
    if constexpr (toml::is_table<decltype(value)>) stream << toml::table{value};
    else stream << value;
  });
  std::string text = stream.str();
  std::erase(text, '\n');
  return text;
}

// Levenshtein distance of two words.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      std::size_t const substituted = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({substituted, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

}  // namespace

std::string in_quotes(std::string_view word) { return fmt::format("\"{}\"", word); }

std::string written(toml::node const& node) {
  std::string const text = in_full(node);
  return text.size() > 80 ? text.substr(0, 76) + " ..." : text;
}

std::string known_names(std::string_view word, std::vector<std::string> const& names) {
  std::string_view nearest;
  std::size_t distance = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (std::string_view name : names)
    if (std::size_t const d = edit_distance(word, name); d < distance) distance = d, nearest = name;
  std::string const hint = nearest.empty() ? "" : fmt::format("did you mean {}? ", in_quotes(nearest));
  return fmt::format("({}known: {})", hint, fmt::join(names, ", "));
}

}  // namespace asterflow

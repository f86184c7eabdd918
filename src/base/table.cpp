#include "base/table.hpp"

#include "base/error.hpp"
#include "base/table_words.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>
#include <toml++/toml.h>

namespace asterflow {

namespace {

struct Source {
  std::string file;
  std::string text;
  std::vector<std::string> overrides;
  toml::table root;
};

[[noreturn]] void fail_override(Source const& source, std::string_view override_text, std::string_view reason) {
  throw SceneError(fmt::format("{}: --set {}: {}", source.file, override_text, reason));
}

// The value of "key=value": TOML, or else a word.
toml::table parse_value(std::string_view value) {
  try {
    return toml::parse(fmt::format("value = {}", value));
  } catch (toml::parse_error const&) {
    toml::table word;
    word.insert("value", std::string(value));
    return word;
  }
}

// A part of the path "table.key": in quotes it may hold dots, and is a name even where it looks like a position.
struct Step {
  std::string word;
  bool is_quoted = false;

  bool is_position() const {
    return !is_quoted && std::all_of(word.begin(), word.end(), [](char c) { return c >= '0' && c <= '9'; });
  }
};

// Takes the first step, and the '.' or '=' that ends it, off the path. Nothing where there is none.
std::optional<Step> take_step(std::string_view& path, char& ended_by) {
  bool const is_quoted = !path.empty() && (path[0] == '"' || path[0] == '\'');
  std::size_t const begin = is_quoted ? 1 : 0;
  std::size_t const end = is_quoted ? path.find(path[0], 1) : path.find_first_of(".=");
  std::size_t const next = end + begin;  // behind a closing quote
  if (end == path.npos || end == begin || next >= path.size() || (path[next] != '.' && path[next] != '=')) return std::nullopt;
  Step const step{std::string(path.substr(begin, end - begin)), is_quoted};
  ended_by = path[next];
  path.remove_prefix(next + 1);
  return step;
}

// The element of [[key]] that a position or a name means; a position one past the end appends a table.
toml::node& array_element(Source const& source, std::string_view whole, toml::array& array, Step const& step) {
  if (step.is_position()) {
    std::size_t position = 0;
    auto const [end, status] = std::from_chars(step.word.data(), step.word.data() + step.word.size(), position);
    if (status == std::errc{} && position < array.size()) return array[position];
    if (status != std::errc{} || position > array.size())
      fail_override(source, whole, fmt::format("there are only {} (positions count from 0)", array.size()));
    array.push_back(toml::table{});
    return array.back();
  }
  std::vector<std::string> names;
  for (auto& element : array)
    if (auto const* table = element.as_table())
      if (auto const name = (*table)["name"].value<std::string>()) {
        if (*name == step.word) return element;
        names.push_back(*name);
      }
  fail_override(source, whole, fmt::format("nothing is named {} {}", in_quotes(step.word), known_names(step.word, names)));
}

// Applies one "table.key=value"; tables and keys that are missing are created.
void apply_override(Source& source, std::string const& whole) {
  if (auto const end = whole.find('\n'); end != std::string::npos)  // trajectories keep one override a line
    fail_override(source, whole.substr(0, end) + " ...", "must be one line");
  std::vector<Step> steps;
  std::string_view rest = whole;
  for (char ended_by = '.'; ended_by != '=';) {
    auto const step = take_step(rest, ended_by);
    if (!step) fail_override(source, whole, "must read table.key=value");
    steps.push_back(*step);
  }
  toml::table value = parse_value(rest);

  toml::node* node = &source.root;
  for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
    if (auto* table = node->as_table()) {
      if (!table->contains(steps[i].word)) {
        if (steps[i + 1].is_position()) table->insert(steps[i].word, toml::array{});
        else table->insert(steps[i].word, toml::table{});
      }
      node = table->get(steps[i].word);
    } else if (auto* array = node->as_array()) {
      node = &array_element(source, whole, *array, steps[i]);
    } else {
      fail_override(source, whole, fmt::format("{} is a value, not a table", in_quotes(steps[i - 1].word)));
    }
  }
  auto* table = node->as_table();
  if (!table) fail_override(source, whole, "the last part must be a key of a table");
  table->insert_or_assign(steps.back().word, std::move(*value.get("value")));
}

}  // namespace

struct Table::Node {
  std::shared_ptr<Source const> source;
  toml::table const* table = nullptr;  // null for a table that the file does not have
  std::string label;                   // "[[body]] #2", empty for the whole file
  std::set<std::string, std::less<>> known = {};
  std::vector<std::string> missing = {};

  toml::node const* find(std::string_view key) {
    known.emplace(key);
    return table ? table->get(key) : nullptr;
  }

  [[noreturn]] void fail(std::string_view message, toml::node const* at) const {
    auto const line = at ? at->source().begin.line : 0;
    bool const in_file = at && at->source().path;  // overrides have no path
    throw SceneError(fmt::format("{}: {}{}{}", source->file, label.empty() ? "" : label + ": ", message,
                                 in_file && line > 0 ? fmt::format(" [line {}]", line) : ""));
  }
  [[noreturn]] void fail(std::string_view key, toml::node const& value, std::string_view must) const {
    bool const in_file = value.source().path != nullptr;
    fail(fmt::format("{} = {}{}: {}", key, written(value), in_file ? "" : " (--set)", must), &value);
  }

  // One finite number within bounds; `entry` may be an element of `whole`, the value of the key.
  double number(std::string_view key, toml::node const& whole, toml::node const& entry, Bounds const& bounds,
                std::string_view unit, bool is_whole) const {
    std::string const each = &whole == &entry ? "" : "every entry ";
    std::string const in_unit = unit.empty() ? "" : fmt::format(" ({})", unit);
    if (is_whole ? !entry.is_integer() : !entry.is_number())
      fail(key, whole, each + (is_whole ? "must be a whole number" : "must be a number") + in_unit);
    double const value = *entry.value<double>();
    if (!std::isfinite(value)) fail(key, whole, each + "must be a finite number" + in_unit);
    if (!bounds.allow(value)) fail(key, whole, each + bounds.words() + in_unit);
    return value;
  }

  // n numbers (any number of them when n = 0).
  std::vector<double> numbers(std::string_view key, toml::node const& whole, toml::node const& list, std::size_t n,
                              Bounds const& bounds, std::string_view unit, bool is_whole = false) const {
    auto const* array = list.as_array();
    std::string const kind = is_whole ? "whole numbers" : "numbers";
    if (!array || (n > 0 && array->size() != n))
      fail(key, whole, fmt::format("must be a list of {}{}{}", n > 0 ? fmt::format("{} ", n) : "", kind,
                                   unit.empty() ? "" : fmt::format(" ({})", unit)));
    std::vector<double> values;
    for (auto const& entry : *array) values.push_back(number(key, whole, entry, bounds, unit, is_whole));
    return values;
  }

  // A list of lists of n numbers.
  std::vector<std::vector<double>> rows(std::string_view key, toml::node const& whole, std::size_t n,
                                        Bounds const& bounds, std::string_view unit) const {
    auto const* array = whole.as_array();
    if (!array) fail(key, whole, fmt::format("must be a list of lists of {} numbers", n));
    std::vector<std::vector<double>> result;
    for (auto const& row : *array) result.push_back(numbers(key, whole, row, n, bounds, unit));
    return result;
  }
};

std::string Bounds::words() const {
  bool const has_lower = std::isfinite(lower), has_upper = std::isfinite(upper);
  if (has_lower && has_upper) return fmt::format("must be {} {} {} {}", lower_excluded ? "above" : "from", lower,
                                                 lower_excluded ? "and at most" : "to", upper);
  if (has_upper) return fmt::format("must be at most {}", upper);
  if (lower_excluded) return lower == 0.0 ? "must be positive" : fmt::format("must be above {}", lower);
  return fmt::format("must be {} or more", lower);
}

void Table::require(std::string_view key) {
  if (!node_->find(key)) node_->missing.emplace_back(key);
}

bool Table::has(std::string_view key) const { return node_->find(key) != nullptr; }

void Table::read(std::string_view key, double& value, Bounds bounds, std::string_view unit) {
  if (auto const* node = node_->find(key)) value = node_->number(key, *node, *node, bounds, unit, false);
}

void Table::read(std::string_view key, int& value, Bounds bounds, std::string_view unit) {
  bounds.lower = std::max(bounds.lower, -2147483648.0), bounds.upper = std::min(bounds.upper, 2147483647.0);
  if (auto const* node = node_->find(key))
    value = static_cast<int>(node_->number(key, *node, *node, bounds, unit, true));
}

void Table::read(std::string_view key, std::uint64_t& value, Bounds bounds, std::string_view unit) {
  bounds.lower = std::max(bounds.lower, 0.0);
  if (auto const* node = node_->find(key)) {
    node_->number(key, *node, *node, bounds, unit, true);
    value = static_cast<std::uint64_t>(*node->value<std::int64_t>());
  }
}

void Table::read(std::string_view key, bool& value) {
  if (auto const* node = node_->find(key)) {
    if (!node->is_boolean()) node_->fail(key, *node, "must be true or false");
    value = *node->value<bool>();
  }
}

void Table::read(std::string_view key, std::string& value) {
  if (auto const* node = node_->find(key)) {
    if (!node->is_string() || node->value<std::string>()->empty()) node_->fail(key, *node, "must be a word in quotes");
    value = *node->value<std::string>();
  }
}

void Table::read(std::string_view key, Vec3d& value, Bounds bounds, std::string_view unit) {
  if (auto const* node = node_->find(key)) {
    auto const v = node_->numbers(key, *node, *node, 3, bounds, unit);
    value = {v[0], v[1], v[2]};
  }
}

void Table::read(std::string_view key, std::array<double, 4>& value, Bounds bounds, std::string_view unit) {
  if (auto const* node = node_->find(key)) {
    auto const v = node_->numbers(key, *node, *node, 4, bounds, unit);
    std::copy(v.begin(), v.end(), value.begin());
  }
}

void Table::read(std::string_view key, Matrix& value, Bounds bounds, std::string_view unit) {
  if (auto const* node = node_->find(key)) {
    auto const rows = node_->rows(key, *node, 3, bounds, unit);
    if (rows.size() != 3) node_->fail(key, *node, "must be 3 lists of 3 numbers");
    for (int i = 0; i < 3; ++i) value[i] = {rows[i][0], rows[i][1], rows[i][2]};
  }
}

void Table::read(std::string_view key, std::vector<double>& value, Bounds bounds, std::string_view unit) {
  if (auto const* node = node_->find(key)) value = node_->numbers(key, *node, *node, 0, bounds, unit);
}

void Table::read(std::string_view key, std::vector<int>& value, Bounds bounds, std::string_view unit) {
  if (auto const* node = node_->find(key)) {
    auto const v = node_->numbers(key, *node, *node, 0, bounds, unit, true);
    value.assign(v.begin(), v.end());
  }
}

void Table::read(std::string_view key, std::vector<std::string>& value) {
  if (auto const* node = node_->find(key)) {
    auto const* array = node->as_array();
    if (!array) node_->fail(key, *node, "must be a list of words in quotes");
    value.clear();
    for (auto const& entry : *array) {
      if (!entry.is_string()) node_->fail(key, *node, "must be a list of words in quotes");
      value.push_back(*entry.value<std::string>());
    }
  }
}

void Table::read(std::string_view key, std::vector<Vec3d>& value, Bounds bounds, std::string_view unit) {
  if (auto const* node = node_->find(key)) {
    value.clear();
    for (auto const& row : node_->rows(key, *node, 3, bounds, unit)) value.push_back({row[0], row[1], row[2]});
  }
}

void Table::read(std::string_view key, std::vector<std::array<double, 2>>& value, Bounds bounds,
                 std::string_view unit) {
  if (auto const* node = node_->find(key)) {
    value.clear();
    for (auto const& row : node_->rows(key, *node, 2, bounds, unit)) value.push_back({row[0], row[1]});
  }
}

std::optional<std::size_t> Table::choose(std::string_view key, std::vector<std::string_view> const& names) {
  auto const* node = node_->find(key);
  if (!node) return std::nullopt;
  auto const word = node->is_string() ? *node->value<std::string>() : std::string();
  auto const match = std::find(names.begin(), names.end(), word);
  if (match == names.end()) node_->fail(key, *node, fmt::format("must be one of {}", fmt::join(names, ", ")));
  return match - names.begin();
}

Table Table::table(std::string_view key) {
  auto const* node = node_->find(key);
  if (node && !node->is_table()) node_->fail(key, *node, fmt::format("must be a table, written [{}]", key));
  std::string const parent = node_->label.empty() ? "" : node_->label + " ";
  return Table(std::make_shared<Node>(
      Node{node_->source, node ? node->as_table() : nullptr, fmt::format("{}[{}]", parent, key)}));
}

std::optional<Table> Table::find_table(std::string_view key) {
  if (!has(key)) return std::nullopt;
  return table(key);
}

std::vector<Table> Table::tables(std::string_view key) {
  std::vector<Table> result;
  auto const* node = node_->find(key);
  if (!node) return result;
  std::string const must = fmt::format("must be a list of tables, each written [[{}]]", key);
  auto const* array = node->as_array();
  if (!array) node_->fail(fmt::format("{} {}", key, must), node);
  for (auto const& element : *array) {
    if (!element.is_table()) node_->fail(fmt::format("{} {}", key, must), node);
    auto const label = fmt::format("[[{}]] #{}", key, result.size() + 1);
    result.push_back(Table(std::make_shared<Node>(Node{node_->source, element.as_table(), label})));
  }
  return result;
}

void Table::finish() {
  if (node_->table)
    for (auto const& [key, value] : *node_->table)
      if (!node_->known.contains(key.str()))
        node_->fail(fmt::format("unknown key {} {}", in_quotes(key.str()),
                                known_names(key.str(), {node_->known.begin(), node_->known.end()})),
                    &value);
  if (!node_->missing.empty())
    node_->fail(fmt::format("key {} is missing", in_quotes(node_->missing.front())), node_->table);
}

void Table::fail(std::string_view key, std::string_view must) const {
  if (auto const* node = node_->find(key)) node_->fail(key, *node, must);
  node_->fail(fmt::format("{}: {}", key, must), node_->table);
}

void Table::fail(std::string_view message) const { node_->fail(message, node_->table); }

std::string const& Table::file() const { return node_->source->file; }
std::string const& Table::text() const { return node_->source->text; }
std::vector<std::string> const& Table::overrides() const { return node_->source->overrides; }

Table parse_table(std::string text, std::string file, std::vector<std::string> const& overrides) {
  auto source = std::make_shared<Source>(Source{std::move(file), std::move(text), overrides, {}});
  try {
    source->root = toml::parse(source->text, source->file);
  } catch (toml::parse_error const& error) {
    throw SceneError(fmt::format("{}: line {}, column {}: {}", source->file, error.source().begin.line,
                                 error.source().begin.column, error.description()));
  }
  for (auto const& one : overrides) apply_override(*source, one);
  return Table(std::make_shared<Table::Node>(Table::Node{source, &source->root, ""}));
}

Table read_table(std::string const& file, std::vector<std::string> const& overrides) {
  if (std::filesystem::is_directory(file)) throw SceneError(file + ": is a folder, not a scene file");
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw SceneError(fmt::format("{}: cannot be read: {}", file, std::strerror(errno)));
  std::ostringstream text;
  text << stream.rdbuf();
  return parse_table(text.str(), file, overrides);
}

}  // namespace asterflow

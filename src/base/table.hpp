#pragma once
// One table of a scene file (TOML), read key by key into a spec. A spec holds its defaults; a key that the
// file has replaces one of them, and whatever is wrong with it becomes a one-line SceneError:
//
//   scene.toml: [[body]] #2: radius = -1: must be positive (um) [line 14]
//   scene.toml: [[body]] #2: unknown key "raduis" (did you mean "radius"? known: name, radius, shape) [line 14]
//
// Usage, next to the module that owns the spec:
//
//   BodySpec read_body(Table table) {
//     BodySpec spec;
//     table.require("radius");
//     table.read("radius", spec.radius, positive, "um");
//     table.finish();          // refuses keys that nothing has read, then names a missing one
//     return spec;
//   }
//
// Copies of a Table are the same table.

#include "base/vec3.hpp"

#include <array>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace asterflow {

// What a number may be. Infinite and undefined numbers are always refused.
struct Bounds {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool lower_excluded = false;

  bool allow(double value) const { return (lower_excluded ? value > lower : value >= lower) && value <= upper; }
  std::string words() const;  // "must be positive", "must be from 8 to 64"
};
inline constexpr Bounds any_number{};
inline constexpr Bounds positive{0.0, std::numeric_limits<double>::infinity(), true};
inline constexpr Bounds not_negative{0.0};
constexpr Bounds between(double lower, double upper) { return {lower, upper}; }
constexpr Bounds at_least(double lower) { return {lower}; }

class Table {
 public:
  using Matrix = std::array<Vec3d, 3>;  // rows

  // The key must be there; finish() complains if it is not.
  void require(std::string_view key);
  bool has(std::string_view key) const;

  // Each leaves `value` alone when the key is absent. `unit` is for the message only.
  void read(std::string_view key, double& value, Bounds bounds = any_number, std::string_view unit = "");
  void read(std::string_view key, int& value, Bounds bounds = any_number, std::string_view unit = "");
  void read(std::string_view key, std::uint64_t& value, Bounds bounds = any_number, std::string_view unit = "");
  void read(std::string_view key, bool& value);
  void read(std::string_view key, std::string& value);  // not empty
  void read(std::string_view key, Vec3d& value, Bounds bounds = any_number, std::string_view unit = "");
  void read(std::string_view key, std::array<double, 4>& value, Bounds bounds = any_number, std::string_view unit = "");
  void read(std::string_view key, Matrix& value, Bounds bounds = any_number, std::string_view unit = "");
  void read(std::string_view key, std::vector<double>& value, Bounds bounds = any_number, std::string_view unit = "");
  void read(std::string_view key, std::vector<int>& value, Bounds bounds = any_number, std::string_view unit = "");
  void read(std::string_view key, std::vector<std::string>& value);
  void read(std::string_view key, std::vector<Vec3d>& value, Bounds bounds = any_number, std::string_view unit = "");
  // Pairs such as a profile [[x, r], ...].
  void read(std::string_view key, std::vector<std::array<double, 2>>& value, Bounds bounds = any_number,
            std::string_view unit = "");
  template <class T, class... Rest>
  void read(std::string_view key, std::optional<T>& value, Rest... rest) {
    T read_value = value.value_or(T{});
    read(key, read_value, rest...);
    if (has(key)) value = read_value;
  }

  // One of a list of words.
  template <class Choice>
  void read_choice(std::string_view key, Choice& value,
                   std::initializer_list<std::pair<std::string_view, Choice>> choices) {
    std::vector<std::string_view> names;
    for (auto const& choice : choices) names.push_back(choice.first);
    if (auto const i = choose(key, names)) value = (choices.begin() + *i)->second;
  }

  Table table(std::string_view key);                // [key]; an empty table when absent
  std::optional<Table> find_table(std::string_view key);
  std::vector<Table> tables(std::string_view key);  // [[key]], in the order of the file

  // Refuses unknown keys, then missing ones.
  void finish();

  // Throws the SceneError of a check that involves more than one key.
  [[noreturn]] void fail(std::string_view key, std::string_view must) const;  // "... key = value: must"
  [[noreturn]] void fail(std::string_view message) const;                     // "... [table]: message"

  std::string const& file() const;                    // as the user wrote it
  std::string const& text() const;                    // the whole scene file
  std::vector<std::string> const& overrides() const;  // "table.key=value", in order

 private:
  struct Node;
  explicit Table(std::shared_ptr<Node> node) : node_(std::move(node)) {}
  std::optional<std::size_t> choose(std::string_view key, std::vector<std::string_view> const& names);
  friend Table parse_table(std::string text, std::string file, std::vector<std::string> const& overrides);

  std::shared_ptr<Node> node_;
};

// The scene in a text, after the overrides "table.key=value". `body.0.force=[1,0,0]` and `body.pnc.force=[1,0,0]`
// reach into [[body]] by position (from 0) or name, in quotes where it holds a dot or looks like a position; missing tables
// and keys are created; a value that is not TOML is taken as a word. `file` names the text in messages.
Table parse_table(std::string text, std::string file, std::vector<std::string> const& overrides = {});

// The same from a file.
Table read_table(std::string const& file, std::vector<std::string> const& overrides = {});

}  // namespace asterflow

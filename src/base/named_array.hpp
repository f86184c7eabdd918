#pragma once
// An array with a name, a shape and a unit: what components hand over to be stored, and get back on resuming.

#include "base/arrays.hpp"

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace asterflow {

struct NamedArray {
  std::string name;                // "body/position"; the part before the last slash is a group
  std::vector<std::size_t> shape;  // the last index runs fastest
  std::variant<std::vector<double>, std::vector<std::int64_t>> values;
  std::string unit;                // "um"; empty for plain numbers
  bool single = false;             // numbers that single precision holds: stored so

  // [n, 3]
  static NamedArray of(std::string name, ConstPoints points, std::string unit) {
    std::vector<double> values;
    values.reserve(3 * points.size());
    for (Vec3d const& p : points) values.insert(values.end(), {p.x, p.y, p.z});
    return {std::move(name), {points.size(), 3}, std::move(values), std::move(unit)};
  }
  // [n]
  static NamedArray of(std::string name, std::vector<double> values, std::string unit) {
    std::size_t const n = values.size();
    return {std::move(name), {n}, std::move(values), std::move(unit)};
  }
  static NamedArray of(std::string name, std::vector<std::int64_t> values) {
    std::size_t const n = values.size();
    return {std::move(name), {n}, std::move(values), ""};
  }
};

inline void append(std::vector<NamedArray>& arrays, std::vector<NamedArray> more) {
  for (NamedArray& array : more) arrays.push_back(std::move(array));
}

}  // namespace asterflow

#pragma once
// Unit vectors by their height along an axis and their turn about it.

#include "base/vec3.hpp"

#include <algorithm>
#include <cmath>

namespace asterflow {

// pi (3 - sqrt 5): turns by multiples of it never come close to each other.
inline constexpr double golden_angle = 2.399963229728653;

struct PolarDirections {
  Vec3d axis, first, second;  // right-handed

  explicit PolarDirections(Vec3d unit_axis)
      : axis(unit_axis), first(normalized(cross(axis, std::abs(axis.x) > 0.6 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0}))),
        second(cross(axis, first)) {}

  // height: -1 ... 1
  Vec3d operator()(double height, double turn) const {
    double const r = std::sqrt(std::max(0.0, 1.0 - height * height));
    return height * axis + (r * std::cos(turn)) * first + (r * std::sin(turn)) * second;
  }
};

}  // namespace asterflow

#pragma once
// What a fast sum can take: numbers whose squares are numbers.

#include "base/arrays.hpp"
#include "base/error.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace asterflow {

// Coordinates may be as large as direct sums take them.
inline constexpr double largest_place = 1e100;

// Throws SceneError that names the first of the points that is not finite, or too large.
inline void require_finite(ConstPoints points, std::string const& what, double largest = 1e150) {
  for (Vec3d const& p : points)
    if (!std::isfinite(p.x + p.y + p.z) || std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) > largest)
      throw SceneError("pair sum: " + what + " " + std::to_string(&p - points.data()) +
                       " is not a finite number below " + (largest < 1e150 ? "1e100" : "1e150"));
}

}  // namespace asterflow

#pragma once
// What a fast sum can take: numbers whose squares are numbers.

#include "base/arrays.hpp"
#include "base/error.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace asterflow {

// Throws SceneError that names the first of the points that is not finite, or too large.
inline void require_finite(ConstPoints points, std::string const& what) {
  for (Vec3d const& p : points)
    if (!std::isfinite(p.x + p.y + p.z) || std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) > 1e150)
      throw SceneError("pair sum: " + what + " " + std::to_string(&p - points.data()) +
                       " is not a finite number below 1e150");
}

}  // namespace asterflow

#include "io/plane.hpp"

#include "base/error.hpp"

#include <cmath>
#include <cstdio>
#include <fmt/format.h>

namespace asterflow {

Plane parse_plane(std::string const& text) {
  Plane plane;
  char axis = 0, rest = 0;
  int const n = std::sscanf(text.c_str(), " %c = %lf %c", &axis, &plane.offset, &rest);
  if (n != 2 || axis < 'x' || axis > 'z' || !std::isfinite(plane.offset))
    throw SceneError(fmt::format("--plane {}: must read x=VALUE, y=VALUE or z=VALUE (um)", text));
  plane.normal = axis - 'x';
  return plane;
}

void parse_grid(std::string const& text, int& n_first, int& n_second) {
  char rest = 0;
  int const n = std::sscanf(text.c_str(), "%dx%d%c", &n_first, &n_second, &rest);
  if (n != 2 || n_first < 2 || n_second < 2 || n_first > 20000 || n_second > 20000)
    throw SceneError(fmt::format("--grid {}: must read COLUMNSxROWS, each from 2 to 20000", text));
}

double PlanePoints::coordinate(int direction, int i) const {
  int const n = direction == 0 ? n_first : n_second;
  return lower[direction] + (upper[direction] - lower[direction]) * i / (n - 1);
}

PointArray PlanePoints::points() const {
  PointArray points(static_cast<std::size_t>(n_first) * n_second);
  for (int j = 0; j < n_second; ++j)
    for (int i = 0; i < n_first; ++i) {
      Vec3d& x = points[static_cast<std::size_t>(j) * n_first + i];
      x[plane.normal] = plane.offset;
      x[plane.first()] = coordinate(0, i);
      x[plane.second()] = coordinate(1, j);
    }
  return points;
}

}  // namespace asterflow

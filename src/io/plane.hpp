#pragma once
// A rectangle of equally spaced points in a plane x, y or z = constant, as the command line gives it.

#include "base/arrays.hpp"

#include <string>

namespace asterflow {

struct Plane {
  int normal = 2;       // 0, 1, 2: x, y, z
  double offset = 0.0;  // um

  int first() const { return normal == 0 ? 1 : 0; }   // axis of the picture's abscissa
  int second() const { return normal == 2 ? 1 : 2; }  // of its ordinate
};

// "z=0", "y = -2.5". Throws SceneError.
Plane parse_plane(std::string const& text);

struct PlanePoints {
  Plane plane;
  int n_first = 0, n_second = 0;
  double lower[2] = {}, upper[2] = {};  // um, of the rectangle

  double coordinate(int direction, int i) const;  // um
  PointArray points() const;                      // [n_second x n_first], first fastest
};

// "240x150". Throws SceneError.
void parse_grid(std::string const& text, int& n_first, int& n_second);

}  // namespace asterflow

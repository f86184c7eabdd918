#include "surface/shape_spec.hpp"

#include <algorithm>
#include <cmath>

namespace asterflow {

namespace {

// Sizes whose squares and cubes are normal numbers, um.
void check_size(Table const& table, std::string_view key, double size) {
  if (size < 1e-50 || size > 1e50) table.fail(key, "must be from 1e-50 to 1e50 (um)");
}

void check_profile(Table const& table, std::vector<std::array<double, 2>> const& profile) {
  if (profile.size() < 3) table.fail("profile", "must have at least 3 points [x, distance from the x axis] (um)");
  if (profile.front()[1] != 0.0 || profile.back()[1] != 0.0)
    table.fail("profile", "must start and end on the x axis, at distance 0 (um)");
  for (std::size_t i = 1; i < profile.size(); ++i) {
    if (profile[i][0] <= profile[i - 1][0]) table.fail("profile", "x must increase from point to point (um)");
    if (i + 1 < profile.size() && profile[i][1] <= 0.0)
      table.fail("profile", "distances between the poles must be positive (um)");
  }
}

}  // namespace

ShapeSpec read_shape(Table& table) {
  using Kind = ShapeSpec::Kind;
  ShapeSpec shape;
  table.require("shape");
  table.read_choice<Kind>("shape", shape.kind,
                          {{"sphere", Kind::sphere}, {"ellipsoid", Kind::ellipsoid}, {"revolution", Kind::revolution}});
  switch (shape.kind) {
    case Kind::sphere:
      table.require("radius");
      table.read("radius", shape.radius, positive, "um");
      check_size(table, "radius", shape.radius);
      break;
    case Kind::ellipsoid:
      table.require("semi_axes");
      table.read("semi_axes", shape.semi_axes, positive, "um");
      for (int i = 0; i < 3; ++i) check_size(table, "semi_axes", shape.semi_axes[i]);
      break;
    case Kind::revolution:
      table.require("profile");
      table.read("profile", shape.profile, any_number, "um");
      if (table.has("profile")) check_profile(table, shape.profile);
      break;
  }
  return shape;
}

double outer_radius(ShapeSpec const& shape) {
  switch (shape.kind) {
    case ShapeSpec::Kind::sphere: return shape.radius;
    case ShapeSpec::Kind::ellipsoid: return std::max({shape.semi_axes.x, shape.semi_axes.y, shape.semi_axes.z});
    case ShapeSpec::Kind::revolution: break;
  }
  double radius = 0.0;
  for (auto const& [x, distance] : shape.profile) radius = std::max(radius, std::hypot(x, distance));
  return radius;
}

}  // namespace asterflow

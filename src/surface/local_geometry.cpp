#include "surface/local_geometry.hpp"

#include "base/polar_directions.hpp"

#include <Eigen/LU>
#include <cmath>

namespace asterflow {

// With tangents T = (t_1, t_2) and changes of the normal N along them, N = S T: S, symmetric, has the curvatures as eigenvalues.
LocalGeometry local_geometry(Shape const& shape, Vec3d direction) {
  constexpr double step = 1e-4;  // radians
  PolarDirections const across(direction);
  Vec3d const v[2] = {across.first, across.second};
  Shape::Columns directions(5, 3), positions, areas;
  for (int i = 0; i < 3; ++i)
    directions.col(i) << direction[i], direction[i] + step * v[0][i], direction[i] - step * v[0][i],
        direction[i] + step * v[1][i], direction[i] - step * v[1][i];
  directions /= std::sqrt(1.0 + step * step);
  directions.row(0) *= std::sqrt(1.0 + step * step);
  shape.sample(directions, positions, areas);
  auto const row = [](Shape::Columns const& columns, int i) { return Vec3d{columns(i, 0), columns(i, 1), columns(i, 2)}; };
  auto const normal = [&](int i) { return normalized(row(areas, i)); };
  Vec3d const n = normal(0), t_1 = normalized(row(positions, 1) - row(positions, 2)), t_2 = normalized(cross(n, t_1));
  Eigen::Matrix2d tangents, changes;
  for (int i = 0; i < 2; ++i) {
    Vec3d const tangent = row(positions, 2 * i + 1) - row(positions, 2 * i + 2), change = normal(2 * i + 1) - normal(2 * i + 2);
    tangents.col(i) << dot(t_1, tangent), dot(t_2, tangent);
    changes.col(i) << dot(t_1, change), dot(t_2, change);
  }
  Eigen::Matrix2d const s = changes * tangents.inverse();
  double const twist = 0.5 * (s(0, 1) + s(1, 0)), mean = 0.5 * (s(0, 0) + s(1, 1)), half = 0.5 * (s(0, 0) - s(1, 1));
  double const angle = 0.5 * std::atan2(twist, half), difference = std::hypot(half, twist);
  Vec3d const principal = std::cos(angle) * t_1 + std::sin(angle) * t_2;
  return {{principal, cross(n, principal)}, {mean + difference, mean - difference}, std::sqrt(norm(row(areas, 0)))};
}

}  // namespace asterflow

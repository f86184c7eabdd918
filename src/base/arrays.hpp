#pragma once
// Views of host arrays that pass between modules. Units and meaning are stated where they are used.
//   Points  [n, 3]  positions, velocities or forces, stored x0 y0 z0 x1 y1 z1 ...
//   Vector  [n]     scalars

#include "base/vec3.hpp"

#include <Eigen/Core>
#include <span>
#include <vector>

namespace asterflow {

using Points = std::span<Vec3d>;
using ConstPoints = std::span<Vec3d const>;
using Vector = std::span<double>;
using ConstVector = std::span<double const>;

using PointArray = std::vector<Vec3d>;

// The same memory as one column of 3 n numbers, for dense algebra.
inline Eigen::Map<Eigen::VectorXd> flat(Points p) {
  return {p.empty() ? nullptr : &p.front().x, static_cast<Eigen::Index>(3 * p.size())};
}
inline Eigen::Map<Eigen::VectorXd const> flat(ConstPoints p) {
  return {p.empty() ? nullptr : &p.front().x, static_cast<Eigen::Index>(3 * p.size())};
}


// [3 n] numbers as n points and back.
inline ConstPoints as_points(ConstVector v) { return {reinterpret_cast<Vec3d const*>(v.data()), v.size() / 3}; }
inline Points as_points(Vector v) { return {reinterpret_cast<Vec3d*>(v.data()), v.size() / 3}; }
inline ConstVector as_vector(ConstPoints p) { return {reinterpret_cast<double const*>(p.data()), 3 * p.size()}; }
inline Vector as_vector(Points p) { return {reinterpret_cast<double*>(p.data()), 3 * p.size()}; }
inline Vector as_vector(PointArray& p) { return as_vector(Points(p)); }

}  // namespace asterflow

#pragma once
// The shape of one fiber: X(s) = X(0) + integral of the unit tangent from 0 to s, 0 <= s <= length.
// Inextensible by construction. s is the material coordinate, counted from the minus end.

#include "base/arrays.hpp"

namespace asterflow {

struct Centreline {
  Vec3d minus_end;      // um
  double length = 0.0;  // um
  PointArray tangents;  // [n_tangent] unit vectors at the Lobatto nodes of the fiber's basis
};

// A straight fiber with that many hydrodynamic nodes.
Centreline straight_centreline(Vec3d minus_end, Vec3d direction, double length, int n_node);

// Positions (um) and tangents at material coordinates s (um); beyond the plus end along the tangent there.
// `tangents` is the interpolated one: of unit length to truncation error. Either output may be empty.
void sample(Centreline const& centreline, ConstVector s, Points positions, Points tangents);

Vec3d plus_end(Centreline const& centreline);

// Integral of |X_ss|^2 ds, 1/um: twice the elastic energy over the bending rigidity.
double squared_curvature(Centreline const& centreline);

}  // namespace asterflow

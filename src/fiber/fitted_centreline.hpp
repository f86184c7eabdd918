#pragma once
// The smooth fiber through given points: a natural cubic spline over chord length, sampled for its tangents.

#include "fiber/centreline.hpp"

namespace asterflow {

// `points`: um, from minus to plus end, at least two, all different from their neighbours. The length is the spline's.
Centreline centreline_through(ConstPoints points, int n_node);

// The given points and, between each two, `n_between` more of the same curve.
PointArray points_between(ConstPoints points, int n_between);

}  // namespace asterflow

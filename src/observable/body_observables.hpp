#pragma once
// Where the bodies of a stored state are and how they move. Columns of each body, NAME its name:
//   NAME_x, _y, _z                          um, centre
//   NAME_angle                              degrees, 0 to 90, between the axis of its first aster and the x axis (of a
//                                           pronuclear complex: the intercentrosomal and the anterior-posterior axis)
//   NAME_velocity_x, ... _speed             um/s
//   NAME_angular_velocity_x, ... _angular_speed   rad/s

#include "io/scene.hpp"
#include "io/trajectory.hpp"
#include "observable/observable.hpp"

namespace asterflow {

Observables body_observables(Scene const& scene, Frame const& frame);

}  // namespace asterflow

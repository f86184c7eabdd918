#pragma once
// A rigid body as a scene describes it: one [[body]] table.

#include "surface/shape_spec.hpp"

#include <Eigen/Geometry>
#include <string>

namespace asterflow {

struct BodySpec {
  enum class Motion { free, prescribed };

  std::string name;                       // of its own; "body1", "body2", ... when not given
  ShapeSpec shape;                        // shape, radius, semi_axes, profile
  Vec3d position;                         // um, of the centre
  Eigen::Quaterniond orientation{1, 0, 0, 0};  // turns body axes into laboratory axes. Keys: orientation = [w, x, y, z],
                                          // or rotation_axis = [x, y, z] with rotation_angle in degrees
  Motion motion = Motion::free;           // free: moved by force and torque; prescribed: by velocity
  Vec3d force;                            // pN, applied at the centre, of a free body
  Vec3d torque;                           // pN um, of a free body
  Vec3d velocity;                         // um/s, of a prescribed body
  Vec3d angular_velocity;                 // rad/s, of a prescribed body
  int order = 0;                          // spectral order of its surface, 4 to 96; 0: from the accuracy of the run
};

// `number` counts the bodies of the scene from 1.
BodySpec read_body(Table table, std::size_t number);

}  // namespace asterflow

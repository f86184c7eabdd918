#pragma once
// The flow of a stored state in a plane, as numbers (HDF5), for ParaView (.vts) and as a picture (.png). The HDF5 file:
//   axes              text   "x y": names of the picture's axes     plane   text   "z=0"
//   first [nx], second [ny]         um, coordinates                 time           s
//   velocity          [ny, nx, 3]   um/s; that of the body inside a body, not a number outside the periphery of a
//                                   confined scene
//   body_distance, periphery_distance [ny, nx]   um, negative inside, when the scene has them
//   fiber/first, fiber/position, fiber/tension   as in the trajectory, with the ends of the fibers added

#include "io/plane.hpp"
#include "io/scene.hpp"
#include "io/trajectory.hpp"

#include <filesystem>
#include <optional>

namespace asterflow {

struct PlaneFlow {
  PlanePoints grid;
  double time = 0.0;    // s
  PointArray velocity;  // [ny, nx] um/s
  std::vector<double> body_distance, periphery_distance;  // [ny, nx] um; empty when there are none
};

// A rectangle that shows everything in the scene at that time, with a margin; the grid is not set.
PlanePoints surrounding(Scene const& scene, Frame const& frame, Plane plane);

PlaneFlow plane_flow(Scene const& scene, Frame const& frame, PlanePoints const& grid);

// Writes PREFIX.h5 and PREFIX.vts and draws PREFIX.png; returns the paths of what there is.
std::vector<std::filesystem::path> write_plane_flow(PlaneFlow const& flow, Frame const& frame,
                                                    std::filesystem::path const& prefix);

}  // namespace asterflow

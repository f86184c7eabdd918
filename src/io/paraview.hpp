#pragma once
// A trajectory as files for ParaView: fibers as chains of points with their tension, bodies and periphery as triangles,
// one .vtp per state and kind of object and one .pvd over all of them.

#include "io/scene.hpp"
#include "io/trajectory.hpp"
#include "io/vtk_file.hpp"

#include <filesystem>

namespace asterflow {

// Fibers from minus to plus end; arrays [n_node] of the state become point arrays.
PolyMesh fiber_mesh(Frame const& frame);
PolyMesh body_mesh(Scene const& scene, Frame const& frame);
PolyMesh periphery_mesh(Scene const& scene);

// Writes FOLDER/asterflow.pvd and what belongs to it; existing files of these names are replaced.
void write_paraview(TrajectoryReader const& trajectory, Scene const& scene, std::filesystem::path const& folder);

}  // namespace asterflow

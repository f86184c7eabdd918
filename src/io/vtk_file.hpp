#pragma once
// Files for ParaView in VTK's XML formats [VTK file formats, version 1.0]: polygonal data (.vtp), structured grids
// (.vts) and collections over time (.pvd). Numbers are stored as raw bytes after the XML header.

#include "base/named_array.hpp"

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace asterflow {

struct PolyMesh {
  PointArray points;                          // [n] um
  std::vector<std::vector<std::int64_t>> lines;  // chains of points
  std::vector<std::array<std::int64_t, 3>> triangles;
  std::vector<NamedArray> point_arrays;       // [n] or [n, 3]
};

void write_vtp(std::filesystem::path const& path, PolyMesh const& mesh);

// Points of a plane, first index fastest, with arrays [n] or [n, 3] at them.
struct PlaneGrid {
  int n_first = 0, n_second = 0;
  PointArray points;  // [n_first x n_second] um
  std::vector<NamedArray> point_arrays;
};

void write_vts(std::filesystem::path const& path, PlaneGrid const& grid);

struct TimedPart {
  double time;       // s
  std::string part;  // name of the object in ParaView
  std::string file;  // relative to the collection
};

void write_pvd(std::filesystem::path const& path, std::vector<TimedPart> const& parts);

}  // namespace asterflow

#include "command/plane_flow.hpp"

#include "io/array_file.hpp"
#include "io/frame.hpp"
#include "io/paraview.hpp"
#include "io/picture.hpp"
#include "io/scene_geometry.hpp"
#include "io/vtk_file.hpp"
#include "io/whole_file.hpp"
#include "system/stored_flow.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <limits>

namespace asterflow {

namespace {

std::string plane_name(Plane const& plane) { return fmt::format("{}={:g}", "xyz"[plane.normal], plane.offset); }

std::vector<std::size_t> shape_of(PlanePoints const& grid) {
  return {static_cast<std::size_t>(grid.n_second), static_cast<std::size_t>(grid.n_first)};
}

void write_numbers(PlaneFlow const& flow, Frame const& frame, std::filesystem::path const& path) {
  auto const& grid = flow.grid;
  ArrayFile file(path, ArrayFile::Mode::create);
  file.write_text("axes", fmt::format("{} {}", "xyz"[grid.plane.first()], "xyz"[grid.plane.second()]));
  file.write_text("plane", plane_name(grid.plane));
  file.write({"time", {}, std::vector<double>{flow.time}, "s"});
  std::vector<double> first, second;
  for (int i = 0; i < grid.n_first; ++i) first.push_back(grid.coordinate(0, i));
  for (int j = 0; j < grid.n_second; ++j) second.push_back(grid.coordinate(1, j));
  file.write(NamedArray::of("first", first, "um"));
  file.write(NamedArray::of("second", second, "um"));
  NamedArray velocity = NamedArray::of("velocity", flow.velocity, "um/s");
  velocity.shape = {shape_of(grid)[0], shape_of(grid)[1], 3};
  file.write(velocity);
  if (!flow.body_distance.empty()) file.write({"body_distance", shape_of(grid), flow.body_distance, "um"});
  if (!flow.periphery_distance.empty())
    file.write({"periphery_distance", shape_of(grid), flow.periphery_distance, "um"});

  PolyMesh const fibers = fiber_mesh(frame);
  std::vector<std::int64_t> first_node{0};
  for (auto const& line : fibers.lines) first_node.push_back(first_node.back() + static_cast<std::int64_t>(line.size()));
  if (!fibers.lines.empty()) {
    file.write(NamedArray::of("fiber/first", first_node));
    file.write(NamedArray::of("fiber/position", fibers.points, "um"));
  }
  for (NamedArray array : fibers.point_arrays) {
    array.name = "fiber/" + array.name;
    file.write(array);
  }
  file.close();
}

}  // namespace

PlanePoints surrounding(Scene const& scene, Frame const& frame, Plane plane) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  PlanePoints grid{plane, 0, 0, {infinity, infinity}, {-infinity, -infinity}};
  auto const include = [&](Vec3d x, double radius) {
    for (int k = 0; k < 2; ++k) {
      double const coordinate = x[k == 0 ? plane.first() : plane.second()];
      grid.lower[k] = std::min(grid.lower[k], coordinate - radius);
      grid.upper[k] = std::max(grid.upper[k], coordinate + radius);
    }
  };
  double margin = 1.0;  // of what is seen on each side, relative to its size
  if (scene.periphery) {
    for (Vec3d const& x : periphery_mesh(scene).points) include(x, 0.0);
    margin = 0.03;
  } else {
    for (auto const& body : bodies_at(scene.bodies, frame)) include(body.position, outer_radius(body.shape));
    for (Vec3d const& x : points_of(frame, "fiber/position")) include(x, 0.0);
    if (grid.lower[0] > grid.upper[0]) include({}, 10.0);
  }
  double const size = std::max({grid.upper[0] - grid.lower[0], grid.upper[1] - grid.lower[1], 1.0});
  for (int k = 0; k < 2; ++k) grid.lower[k] -= margin * size, grid.upper[k] += margin * size;
  return grid;
}

PlaneFlow plane_flow(Scene const& scene, Frame const& frame, PlanePoints const& grid) {
  PlaneFlow flow{grid, frame.time, {}, {}, {}};
  PlacedScene const placed(bodies_at(scene.bodies, frame), scene.periphery ? &scene.periphery->shape : nullptr);
  auto const motion = points_of(frame, "body/velocity"), turning = points_of(frame, "body/angular_velocity");
  bool const is_closed = placed.periphery && scene.run.interactions == Interactions::confined;
  PointArray const points = grid.points();
  constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
  flow.velocity.assign(points.size(), Vec3d{nothing, nothing, nothing});
  std::vector<std::size_t> in_fluid;
  for (std::size_t i = 0; i < points.size(); ++i) {
    double nearest = std::numeric_limits<double>::infinity();
    int inside = -1;
    for (std::size_t b = 0; b < placed.bodies.size(); ++b) {
      double const distance = placed.bodies[b].signed_distance(points[i]);
      nearest = std::min(nearest, distance);
      if (distance <= 0.0) inside = static_cast<int>(b);
    }
    if (!placed.bodies.empty()) flow.body_distance.push_back(nearest);
    double const outside = placed.periphery ? placed.periphery->signed_distance(points[i]) : -1.0;
    if (placed.periphery) flow.periphery_distance.push_back(outside);
    if (inside >= 0) flow.velocity[i] = motion[inside] + cross(turning[inside], points[i] - placed.bodies[inside].position());
    else if (!is_closed || outside < 0.0) in_fluid.push_back(i);
  }
  PointArray fluid_points, fluid_velocity(in_fluid.size());
  for (std::size_t i : in_fluid) fluid_points.push_back(points[i]);
  StoredFlow(scene, frame).velocity(fluid_points, fluid_velocity);
  for (std::size_t i = 0; i < in_fluid.size(); ++i) flow.velocity[in_fluid[i]] = fluid_velocity[i];
  return flow;
}

std::vector<std::filesystem::path> write_plane_flow(PlaneFlow const& flow, Frame const& frame,
                                                    std::filesystem::path const& prefix) {
  std::filesystem::path const numbers = prefix.string() + ".h5", grid = prefix.string() + ".vts",
                              picture = prefix.string() + ".png";
  write_whole(numbers, [&](std::filesystem::path const& part) { write_numbers(flow, frame, part); });
  write_whole(grid, [&](std::filesystem::path const& part) {
    write_vts(part, {flow.grid.n_first, flow.grid.n_second, flow.grid.points(),
                     {NamedArray::of("velocity", flow.velocity, "um/s")}});
  });
  std::vector<std::filesystem::path> written{numbers, grid};
  if (draw_picture("plot_flow.py", {numbers.string(), picture.string()})) written.push_back(picture);
  return written;
}

}  // namespace asterflow

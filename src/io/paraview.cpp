#include "io/paraview.hpp"

#include "base/error.hpp"
#include "io/frame.hpp"
#include "io/output_folder.hpp"
#include "io/surface_mesh.hpp"

#include <fmt/format.h>

namespace asterflow {

namespace {

constexpr int n_body_rings = 24, n_periphery_rings = 48;

// Values at the nodes of each fiber, with the end nodes' values repeated at the ends.
std::vector<double> with_ends(std::vector<double> const& values, std::vector<std::int64_t> const& first) {
  std::vector<double> result;
  for (std::size_t i = 0; i + 1 < first.size(); ++i) {
    if (first[i] == first[i + 1]) continue;
    result.push_back(values.at(first[i]));
    result.insert(result.end(), values.begin() + first[i], values.begin() + first[i + 1]);
    result.push_back(values.at(first[i + 1] - 1));
  }
  return result;
}

}  // namespace

PolyMesh fiber_mesh(Frame const& frame) {
  PolyMesh mesh;
  auto const first = integers_of(frame, "fiber/first");
  auto const nodes = points_of(frame, "fiber/position");
  auto const minus = points_of(frame, "fiber/minus_end"), plus = points_of(frame, "fiber/plus_end");
  for (std::size_t i = 0; i + 1 < first.size(); ++i) {
    if (first[i] == first[i + 1]) continue;
    std::vector<std::int64_t> line;
    auto const add_point = [&](Vec3d x) {
      line.push_back(static_cast<std::int64_t>(mesh.points.size()));
      mesh.points.push_back(x);
    };
    add_point(minus.at(i));
    for (auto j = first[i]; j < first[i + 1]; ++j) add_point(nodes.at(j));
    add_point(plus.at(i));
    mesh.lines.push_back(std::move(line));
  }
  for (auto const& array : frame.arrays) {
    bool const is_nodal = array.name.starts_with("fiber/") && array.shape == std::vector{nodes.size()};
    if (auto const* values = std::get_if<std::vector<double>>(&array.values); is_nodal && values)
      mesh.point_arrays.push_back(NamedArray::of(array.name.substr(6), with_ends(*values, first), array.unit));
  }
  return mesh;
}

PolyMesh body_mesh(Scene const& scene, Frame const& frame) {
  PolyMesh mesh;
  auto const positions = points_of(frame, "body/position");
  auto const orientations = orientations_of(frame);
  auto const velocity = points_of(frame, "body/velocity"), turning = points_of(frame, "body/angular_velocity");
  std::vector<std::int64_t> index;
  PointArray surface_velocity;
  for (std::size_t b = 0; b < positions.size(); ++b) {
    add_surface(scene.bodies.at(b).shape, positions[b], orientations.at(b), n_body_rings, mesh);
    index.resize(mesh.points.size(), static_cast<std::int64_t>(b));
    for (std::size_t i = surface_velocity.size(); i < mesh.points.size() && !velocity.empty(); ++i)
      surface_velocity.push_back(velocity.at(b) + cross(turning.at(b), mesh.points[i] - positions[b]));
  }
  mesh.point_arrays.push_back(NamedArray::of("body", std::move(index)));
  if (!velocity.empty()) mesh.point_arrays.push_back(NamedArray::of("velocity", surface_velocity, "um/s"));
  return mesh;
}

PolyMesh periphery_mesh(Scene const& scene) {
  PolyMesh mesh;
  if (scene.periphery)
    add_surface(scene.periphery->shape, {}, Eigen::Quaterniond::Identity(), n_periphery_rings, mesh);
  return mesh;
}

void write_paraview(TrajectoryReader const& trajectory, Scene const& scene, std::filesystem::path const& folder) {
  make_output_folder(folder);
  std::vector<TimedPart> parts;
  auto const add = [&](double time, std::string const& part, std::string const& name, PolyMesh const& mesh) {
    if (!mesh.points.empty()) write_vtp(folder / name, mesh);
    if (!mesh.points.empty()) parts.push_back({time, part, name});
  };
  PolyMesh const periphery = periphery_mesh(scene);
  if (!periphery.points.empty()) write_vtp(folder / "periphery.vtp", periphery);
  for (std::size_t i = 0; i < trajectory.times().size(); ++i) {
    Frame const frame = trajectory.frame(i);
    add(frame.time, "fibers", fmt::format("fibers_{:06}.vtp", i), fiber_mesh(frame));
    add(frame.time, "bodies", fmt::format("bodies_{:06}.vtp", i), body_mesh(scene, frame));
    if (!periphery.points.empty()) parts.push_back({frame.time, "periphery", "periphery.vtp"});
  }
  write_pvd(folder / "asterflow.pvd", parts);
}

}  // namespace asterflow

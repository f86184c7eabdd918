#include "io/frame.hpp"

#include "base/error.hpp"

namespace asterflow {

NamedArray const* find_array(Frame const& frame, std::string const& name) {
  for (auto const& array : frame.arrays)
    if (array.name == name) return &array;
  return nullptr;
}

std::vector<double> numbers_of(Frame const& frame, std::string const& name) {
  auto const* array = find_array(frame, name);
  if (!array) return {};
  auto const* values = std::get_if<std::vector<double>>(&array->values);
  if (!values) throw SceneError(frame.place + "/" + name + ": must hold floating-point numbers");
  return *values;
}

std::vector<std::int64_t> integers_of(Frame const& frame, std::string const& name) {
  auto const* array = find_array(frame, name);
  if (!array) return {};
  auto const* values = std::get_if<std::vector<std::int64_t>>(&array->values);
  if (!values) throw SceneError(frame.place + "/" + name + ": must hold whole numbers");
  return *values;
}

PointArray points_of(Frame const& frame, std::string const& name) {
  auto const values = numbers_of(frame, name);
  if (values.size() % 3 != 0) throw SceneError(frame.place + "/" + name + ": must have shape [n, 3]");
  PointArray points(values.size() / 3);
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
  return points;
}

std::vector<Eigen::Quaterniond> orientations_of(Frame const& frame, std::string const& name) {
  auto const values = numbers_of(frame, name);
  std::vector<Eigen::Quaterniond> orientations;
  for (std::size_t i = 0; i + 3 < values.size(); i += 4)
    orientations.emplace_back(values[i], values[i + 1], values[i + 2], values[i + 3]);
  return orientations;
}

std::vector<RigidPose> flow_poses(Frame const& frame) {
  PointArray positions = points_of(frame, "body/flow_position");
  std::vector<Eigen::Quaterniond> orientations = orientations_of(frame, "body/flow_orientation");
  if (positions.empty()) {  // before the first step
    positions = points_of(frame, "body/position");
    orientations = orientations_of(frame);
  }
  std::vector<RigidPose> poses;
  for (std::size_t b = 0; b < positions.size(); ++b) poses.push_back({positions[b], orientations.at(b).toRotationMatrix()});
  return poses;
}

PointArray flow_nodes(Frame const& frame) {
  return points_of(frame, find_array(frame, "fiber/flow_position") ? "fiber/flow_position" : "fiber/position");
}

std::vector<BodySpec> bodies_at(std::vector<BodySpec> bodies, Frame const& frame) {
  auto const poses = flow_poses(frame);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    bodies[b].position = poses.at(b).position;
    bodies[b].orientation = Eigen::Quaterniond(poses[b].rotation);
  }
  return bodies;
}

}  // namespace asterflow

#include "body/body_spec.hpp"

#include <cmath>
#include <numbers>

namespace asterflow {

namespace {

// A unit quaternion, or axis and angle; without either the body axes are the laboratory axes.
Eigen::Quaterniond read_orientation(Table& table) {
  std::array<double, 4> q{1.0, 0.0, 0.0, 0.0};
  table.read("orientation", q);
  double const length = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
  if (std::abs(length - 1.0) > 1e-6) table.fail("orientation", "must be a unit quaternion [w, x, y, z]");

  Vec3d axis{0.0, 0.0, 1.0};
  double angle = 0.0;  // degrees
  table.read("rotation_axis", axis);
  table.read("rotation_angle", angle, any_number, "degrees");
  if (norm(axis) == 0.0) table.fail("rotation_axis", "must not be zero");
  if (table.has("rotation_axis") != table.has("rotation_angle"))
    table.fail("rotation_axis and rotation_angle go together");
  if (!table.has("rotation_axis")) return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized();
  if (table.has("orientation")) table.fail("give orientation or rotation_axis, not both");
  axis = normalized(axis);
  return Eigen::Quaterniond(
      Eigen::AngleAxisd(angle * std::numbers::pi / 180.0, Eigen::Vector3d(axis.x, axis.y, axis.z)));
}

// Keys that the body's kind of motion would ignore are refused.
void read_motion(Table& table, BodySpec& body) {
  using Motion = BodySpec::Motion;
  table.read_choice<Motion>("motion", body.motion, {{"free", Motion::free}, {"prescribed", Motion::prescribed}});
  table.read("force", body.force, any_number, "pN");
  table.read("torque", body.torque, any_number, "pN um");
  table.read("velocity", body.velocity, any_number, "um/s");
  table.read("angular_velocity", body.angular_velocity, any_number, "rad/s");
  bool const is_free = body.motion == Motion::free;
  for (char const* key : {"velocity", "angular_velocity"})
    if (is_free && table.has(key)) table.fail(key, "needs motion = \"prescribed\"; a free body moves by force and torque");
  for (char const* key : {"force", "torque"})
    if (!is_free && table.has(key)) table.fail(key, "needs motion = \"free\"; a prescribed body moves by velocity");
}

}  // namespace

BodySpec read_body(Table table, std::size_t number) {
  BodySpec body;
  body.name = "body" + std::to_string(number);
  table.read("name", body.name);
  if (body.name.find_first_of(",\"\n\r") != std::string::npos)
    table.fail("name", "heads columns of tables: must hold no comma, quote or end of line");
  table.read("position", body.position, any_number, "um");
  table.read("order", body.order, between(4, 96));
  body.shape = read_shape(table);
  body.orientation = read_orientation(table);
  read_motion(table, body);
  table.finish();
  return body;
}

}  // namespace asterflow

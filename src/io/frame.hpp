#pragma once
// Access to the arrays of a stored state by name; names and shapes are those of docs/trajectory.md.

#include "base/rigid.hpp"
#include "body/body_spec.hpp"
#include "io/trajectory.hpp"

#include <Eigen/Geometry>

namespace asterflow {

// Null when the state does not have it.
NamedArray const* find_array(Frame const& frame, std::string const& name);

// Empty when the state does not have it.
PointArray points_of(Frame const& frame, std::string const& name);                // [n, 3]
std::vector<double> numbers_of(Frame const& frame, std::string const& name);      // [n]
std::vector<std::int64_t> integers_of(Frame const& frame, std::string const& name);  // [n]
std::vector<Eigen::Quaterniond> orientations_of(Frame const& frame, std::string const& name = "body/orientation");

// Where bodies and nodes of fibers were when the state's flow was solved: as the step had predicted them.
std::vector<RigidPose> flow_poses(Frame const& frame);
PointArray flow_nodes(Frame const& frame);

// The bodies of a scene there.
std::vector<BodySpec> bodies_at(std::vector<BodySpec> bodies, Frame const& frame);

}  // namespace asterflow

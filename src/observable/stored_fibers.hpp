#pragma once
// The fibers of a stored state with what the scene says about them, and calculus along them. The positions of a fiber at
// its Gauss-Legendre nodes and ends are those of one polynomial in s.

#include "io/scene.hpp"
#include "io/trajectory.hpp"

namespace asterflow {

struct StoredFibers {
  std::vector<std::int64_t> first;         // [n_fiber + 1]
  std::vector<double> length;              // [n_fiber] um
  PointArray minus_end, plus_end;          // [n_fiber] um
  PointArray position;                     // [n_node] um
  std::vector<double> weight, tension;     // [n_node] um, pN
  PointArray force_density;                // [n_node] pN/um, on the fluid
  std::vector<std::int64_t> body;          // [n_fiber] that holds the minus end, -1: none
  std::vector<std::int64_t> tip_state;     // [n_fiber] of TipState
  PointArray plus_end_force;               // [n_fiber] pN, on the plus end
  PointArray minus_end_force, minus_end_torque;  // [n_fiber] pN, pN um, on what holds the minus end, about that end
  PointArray contact_force;                // [n_fiber] pN, of the cortex on its nodes
  PointArray contact_torque;               // [n_fiber] pN um, of the same about the minus end
  std::vector<double> motor_load;          // [n_fiber] pN/um, along the tangent
  std::vector<FiberMaterialSpec> material;  // [n_fiber]
  PointArray external_load;                // [n_fiber] pN/um, along the whole fiber

  std::size_t count() const { return length.size(); }
  int node_count(std::size_t fiber) const { return static_cast<int>(first[fiber + 1] - first[fiber]); }
};

// States stored before a mechanism existed have zeros in its arrays. Throws SceneError when the fibers are not those of
// the scene.
StoredFibers stored_fibers(Scene const& scene, Frame const& frame);

// Unit tangents [n] and curvature vectors X_ss [n] (1/um) at the nodes of a fiber, overwritten.
void differentiate(StoredFibers const& fibers, std::size_t fiber, Points tangents, Points curvatures);

// A field given at the nodes of a fiber, extrapolated to an end: alpha = 0 or 1.
Vec3d value_at_end(ConstPoints field, double alpha);

}  // namespace asterflow

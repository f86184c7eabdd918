#pragma once
// The flow of a stored state, from its force densities, motions and incident flows (docs/trajectory.md): no solve.

#include "io/scene.hpp"
#include "io/trajectory.hpp"
#include "system/flows.hpp"

#include <memory>

namespace asterflow {

class StoredFlow {
 public:
  // Throws SceneError when the state holds no flow: level `local`, or stored before the first solve.
  StoredFlow(Scene const& scene, Frame const& frame);
  // The same with the surfaces' flows at hand.
  StoredFlow(Scene const& scene, SceneFlows const& flows, Frame const& frame);

  // velocity [n] (um/s) at points [n] of the fluid, overwritten.
  void velocity(ConstPoints points, Points velocity) const;

  // Flow of all other objects and the background at the fibers' nodes, um/s.
  PointArray incident_at_fibers() const;

  Radiation const& radiation() const { return *radiation_; }
  std::vector<Vector6> const& motions() const { return motions_; }  // [n_body] um/s, 1/s
  // Flow of all other objects at the nodes of bodies and periphery, um/s.
  ConstPoints surface_incident() const { return ConstPoints(incident_).subspan(force_density_.size()); }

 private:
  Scene scene_;
  std::unique_ptr<Radiation> radiation_;
  PointArray force_density_, incident_;
  std::vector<Vector6> motions_;
};

}  // namespace asterflow

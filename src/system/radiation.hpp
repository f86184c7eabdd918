#pragma once
// The flow that every object of a scene sends to all the others, at one resolution.
//
// Nodes are numbered: hydrodynamic nodes of the fibers, then surface nodes of each body, then those of the periphery.
// Incident flow means, at the nodes of one object, the velocity due to all OTHER objects. An object's own flow is
//   fiber      sum of Stokeslets of strength weight x force density over its nodes     [paper, Eq. 3b]
//              and, where a body or the periphery is close, of their images behind it (wall_images.hpp); bounded at nodes of other
//              fibers that are too close to be resolved (close_nodes.hpp)
//   body       exterior Dirichlet flow with wall velocity U + Omega x r - incident     [Eq. 3d, 5]
//   periphery  interior Dirichlet flow with wall velocity - incident                   [Eq. 3c, 4]

#include "base/arrays.hpp"
#include "base/rigid.hpp"
#include "surface/dirichlet_flow.hpp"
#include "system/close_nodes.hpp"
#include "system/deep_targets.hpp"
#include "system/wall_images.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace asterflow {

class Evaluator;

// Nodes of fibers, one after the other; fiber i owns [first[i], first[i + 1]).
struct FiberNodes {
  ConstPoints positions;                // um
  ConstVector weights;                  // um
  std::vector<std::size_t> const* first;  // [n_fiber + 1]
};

struct RadiationOptions {
  double viscosity = 1.0;  // pN s/um^2
  std::string evaluator = "auto";
  double accuracy = 1e-6;  // of the pair sums
  bool has_images_behind_periphery = true, has_images_in_bodies = true;
  std::optional<ImageWall> near_periphery = std::nullopt;            // as images behind it see it; none: a plane wall at every foot
  std::shared_ptr<ScreenedForces const> screened_forces = nullptr;  // what its nodes take of forces close to it; null: samples
};

// As accurate as asked for, or at a fraction of the cost: for the inside of a preconditioner.
enum class Exchange { accurate, rough };

// Force and torque about the centre, over viscosity and in the frame of the body, on a surface that is held in a flow.
// incident [n_node of the surface], um/s.
Vector6 load_in_body_frame(DirichletFlow const& flow, RigidPose const& pose, ConstPoints incident);

class Radiation {
 public:
  using Flow = std::shared_ptr<DirichletFlow const>;

  // One exterior flow per body; an interior one where there is a periphery.
  Radiation(std::vector<Flow> body_flows, Flow periphery_flow, RadiationOptions options);
  ~Radiation();

  // Fixes the geometry of a time step.
  void set_geometry(FiberNodes const& fibers, std::vector<RigidPose> const& poses);

  ConstPoints nodes() const { return nodes_; }
  std::size_t n_fiber_nodes() const { return n_fiber_nodes_; }
  std::size_t first_body_node(std::size_t body) const { return first_[body]; }
  std::size_t first_periphery_node() const { return first_.back(); }
  bool has_rough_exchange() const { return rough_stokeslets_ != nullptr; }
  bool has_periphery() const { return periphery_ != nullptr; }
  RigidPose const& body_pose(std::size_t body) const { return poses_[body]; }
  Surface const& body_surface(std::size_t body) const { return bodies_[body]->surface(); }
  Surface const& periphery_surface() const { return periphery_->surface(); }

  // Force and torque (about its centre, pN and pN um) of the incident flow on a body that holds still, as Faxen's laws
  // give for a sphere. A body that moves with q exerts resistance q - this on the fluid.
  Vector6 load_of_incident(std::size_t body, ConstPoints incident) const;

  // received [n_node] += flow of all other objects; on entry the imposed flow.
  //   force_density [n_fiber_node]  pN/um, on the fluid
  //   motions, is_free [n_body]     velocity and angular velocity of each body; whether its load determines them
  //   incident [n_node]             um/s, read at the nodes of bodies and periphery
  // Fibers and periphery receive the flow by which a body answers to what it receives now, a free one at the force that it
  // exerts with `motions` and `incident`. The fixed point incident = received is that of the answers to `incident`, but half
  // as many iterations lead there.
  void exchange(ConstPoints force_density, std::vector<Vector6> const& motions, std::vector<bool> const& is_free,
                ConstPoints incident, Points received, Exchange kind = Exchange::accurate);

  // Velocity of all objects at points of the fluid, added.
  void add_velocity(ConstPoints force_density, std::vector<Vector6> const& motions, ConstPoints incident,
                    ConstPoints targets, Points velocity) const;

  std::size_t memory() const;

  // Wall time since it was made, s.
  struct Seconds {
    double geometry = 0.0, sums = 0.0, surfaces = 0.0, rough_sums = 0.0, rough_surfaces = 0.0;
  };
  Seconds const& seconds() const { return seconds_; }

 private:
  void place_nodes(FiberNodes const& fibers);
  void plan_surfaces();
  void plan_fibers(FiberNodes const& fibers);
  Vector6 load_in_body_frame(std::size_t body, ConstPoints incident) const;  // over viscosity
  PointArray wall_velocity(std::size_t body, Vector6 const& motion, ConstPoints incident) const;
  Vector6 motion_at_same_force(std::size_t body, Vector6 const& motion, ConstPoints before, ConstPoints now) const;
  PointArray periphery_wall_velocity(ConstPoints incident) const;
  void add_fibers(ConstPoints force_density, Exchange kind, Points received);
  void plan_images(FiberNodes const& fibers);
  void add_images(bool is_rough, Points received) const;
  std::size_t n_receiving_images(std::size_t wall, bool is_rough) const;  // of the nodes, the first
  struct BodyTargets {  // of one body: nodes [first, last) but for [gap, gap_end)
    std::size_t first = 0, last = 0, gap = 0, gap_end = 0;
    DirichletFlow::Targets plan;
    std::size_t node(std::size_t i) const { return first + i < gap ? first + i : first + i + gap_end - gap; }
  };
  void plan_body_targets(std::size_t body, BodyTargets& targets) const;
  void add_body(std::size_t body, Vector6 const& motion, ConstPoints incident, BodyTargets const& targets, Exchange kind,
                Points received) const;
  void add_periphery(ConstPoints incident, Exchange kind, Points received);

  std::vector<Flow> bodies_;
  Flow periphery_;
  RadiationOptions options_;
  std::unique_ptr<Evaluator> stokeslets_;        // none while there are no fibers
  std::unique_ptr<Evaluator> rough_stokeslets_;  // nor while accurate ones are as cheap

  std::vector<Matrix6> mobilities_;  // of each body alone in its frame, times viscosity
  std::vector<RigidPose> poses_;
  std::vector<std::size_t> first_fiber_node_;  // [n_fiber + 1]
  std::vector<std::size_t> first_;             // [n_body + 1] first node of each body, then of the periphery
  std::size_t n_fiber_nodes_ = 0;
  PointArray nodes_;
  std::vector<double> weights_;
  std::vector<WallImages> images_;  // in each body, then behind the periphery
  std::vector<DeepTargets> deep_targets_;  // of the images behind the periphery: accurate, rough
  std::vector<BodyTargets> neighbours_;          // per body: nodes of the other bodies
  std::vector<BodyTargets> others_;              // per body: nodes of fibers and periphery
  DirichletFlow::Targets periphery_targets_;     // all nodes but its own
  CloseNodes close_nodes_;
  PointArray strengths_;                              // [n_fiber_node] pN over viscosity
  Seconds seconds_;
};

}  // namespace asterflow

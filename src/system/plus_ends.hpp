#pragma once
// The plus ends of a scene's growing fibers during one step: growth and chance (dynamic instability), and the cortex that
// turns them back, is pushed by them, or captures and pulls them.
//   begin_step of the fibers; plan();  prepare of the fibers;  hold();  solve, advance of the fibers;  accept of both

#include "fiber/dynamic_instability.hpp"
#include "fiber/fibers.hpp"
#include "io/scene.hpp"
#include "mechanism/cortical_pulling.hpp"
#include "mechanism/pushing.hpp"

#include <optional>

namespace asterflow {

class PlusEnds {
 public:
  explicit PlusEnds(Scene const& scene);  // with [dynamic_instability]

  // Lets a fiber grow and shrink from now on. `spring_stiffness`: of its contact with the cortex, pN/um.
  void add(std::size_t fiber, double length, double spring_stiffness);

  // Of a straight fiber, um: `length`, or less where its plus end would push the cortex from the start.
  double length_at_rest(double length, Vec3d plus_end, Vec3d tangent) const;

  // Lengths, renucleation and explicit loads of the step; `poses`, `motions` [n_body] at its beginning.
  void plan(double dt, Fibers& fibers, std::span<RigidPose const> poses, std::span<Vector6 const> motions);
  // Loads and lengths of those that the cortex holds, implicit; u [n_node]: incident flow, extrapolated.
  void hold(Fibers& fibers, ConstPoints u, std::span<BodyMotionMap const> bodies);
  // Largest local error of a length in the trial step, um.
  double error_estimate() const;
  void accept(Fibers const& fibers);  // after the fibers have accepted

  TipState state_of(std::size_t fiber) const { return growth_.state_of(fiber); }
  DynamicInstability const& growth() const { return growth_; }
  std::optional<CorticalPulling> const& cortical_pulling() const { return pulling_; }

  std::vector<NamedArray> state() const;
  void restore(std::span<NamedArray const> state);

 private:
  TipSurroundings surroundings(std::size_t tip, Fibers const& fibers, std::span<RigidPose const> poses,
                               std::span<Vector6 const> motions, double dt);
  Vec3d tip_velocity(std::size_t fiber, Fibers const& fibers, std::span<RigidPose const> poses,
                     std::span<Vector6 const> motions) const;
  void share_sites(double dt);
  void plan_release(std::size_t tip, Fibers& fibers);
  void plan_loads(std::size_t tip, Fibers& fibers);
  void hold_pushing(std::size_t tip, Fibers& fibers, TipAnswer const& answer);
  void hold_captured(std::size_t tip, Fibers& fibers, TipAnswer const& answer);
  double pushing_length(std::size_t tip, TipAnswer const& answer, Vec3d tangent, double planned) const;

  DynamicInstability growth_;
  std::optional<CortexSurface> cortex_;
  std::optional<Pushing> pushing_;
  std::optional<CorticalPulling> pulling_;
  int dividing_body_ = -1;
  Vec3d posterior_{1, 0, 0};
  double fixed_plane_ = 0.0;  // um

  double dt_ = 0.0, plane_ = 0.0;  // of the step: s, um
  std::vector<TipSurroundings> surroundings_;
  PointArray velocities_;          // [n_tip] um/s, of the material at the tip
  std::vector<double> speeds_;     // [n_tip] um/s, of captured fibers
  std::vector<double> errors_;     // [n_tip] um
};

}  // namespace asterflow

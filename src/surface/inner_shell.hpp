#pragma once
// A Stokes flow inside a closed surface whose sources all lie behind it, known on a smaller copy of the surface (scaled by
// rho < 1 about its centre). Within the copy it is the solution of the Dirichlet problem there, and as the copy is similar to
// the surface, the operator of the surface gives it,
//   u(c + x) = D[u at the nodes of the copy](c + x / rho),   c the centre.
// A flow of many sources is so summed at the nodes of the copy and at what lies outside of it, not at all targets. The copy
// must be so small that its nodes resolve the flow: mode l of a source on the surface of a sphere has decayed by rho^l.

#include "surface/dirichlet_flow.hpp"

#include <memory>

namespace asterflow {

class InnerShell {
 public:
  // The largest copy that gives the flow of images (plane_image.hpp) of forces on the surface to the relative accuracy, measured
  // by a few images all around. rough: by the rough evaluation of the flow.
  InnerShell(std::shared_ptr<DirichletFlow const> interior, bool is_rough, double accuracy);

  double scale() const { return scale_; }          // rho; 0 where no copy is accurate enough
  ConstPoints nodes() const { return nodes_; }     // of the copy, um
  std::size_t memory() const;                      // bytes

  // Targets by their places among those planned for the surface itself, overwritten.
  void plan(DirichletFlow::Targets const& targets);
  std::vector<std::size_t> const& inside() const { return inside_; }

  // velocity [target] += the flow that is `samples` at the nodes, for the targets inside.
  void add_velocity(ConstPoints samples, Points velocity) const;

 private:
  void set_scale(double scale);
  double error() const;  // relative, of the present copy
  void continue_inwards(ConstPoints samples, DirichletFlow::Targets const& targets, Points velocity) const;

  std::shared_ptr<DirichletFlow const> flow_;
  bool is_rough_;
  double scale_ = 0.0;
  PointArray nodes_;
  DirichletFlow::Targets targets_;  // those inside, of the copy
  std::vector<std::size_t> inside_;
};

}  // namespace asterflow

#pragma once
// The preconditioner of the coupled problem: the same multiple scattering on coarse nodes, solved loosely.
// Fibers keep their exact answers; only their nodes for the exchange are fewer, as are those of the surfaces.

#include "system/fiber_coarsening.hpp"
#include "system/scattering.hpp"

#include <Eigen/Core>

namespace asterflow {

class CoarseScattering {
 public:
  CoarseScattering(Scattering const& problem, FiberNodes const& fibers, std::vector<BodyDrive> const& bodies,
                   Radiation const& fine, Radiation& coarse, ScatteringOptions const& options);

  // result = r + P ((I - L_c)^-1 - I) P+ r
  void precondition(ConstVector r, Vector result);

  int iterations() const { return iterations_; }  // of all solves so far
  double seconds() const { return seconds_; }     // wall time of all solves so far

 private:
  void restrict_nodes(ConstPoints fine, Points coarse) const;
  void add_prolonged(ConstPoints coarse, Points fine) const;
  void apply(ConstVector z, Vector result);

  // Grid transfers of one surface and where its nodes begin.
  struct SurfaceTransfer {
    std::size_t first_fine, first_coarse;
    Eigen::MatrixXd const* restriction;
    Eigen::MatrixXd const* prolongation;
  };

  Scattering const& problem_;
  Radiation& coarse_;
  ScatteringOptions options_;
  FiberCoarsening fibers_;
  std::vector<SurfaceTransfer> surfaces_;
  std::size_t n_body_, n_fiber_node_;
  PointArray fine_velocity_, fine_force_, coarse_force_;
  int iterations_ = 0;
  double seconds_ = 0.0;
};

}  // namespace asterflow

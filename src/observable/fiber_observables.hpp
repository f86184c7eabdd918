#pragma once
// What the fibers of a stored state do, by themselves. Columns:
//   fibers_growing, _shrinking, _pushing, _captured   numbers of plus ends
//   plus_end_force, minus_end_force    pN, sum of the magnitudes over fibers whose plus end pushes or is captured
//   end_force_ratio                    minus_end_force / plus_end_force
//   net_plus_end_force, net_minus_end_force  pN, magnitude of the vector sums over the same fibers
//   length_mean, _deviation, _least, _largest         um
//   curvature_mean, curvature_largest  1/um: root of the mean square along all fibers, and largest
//   tension_mean, _least, _largest     pN, along all fibers; negative: compression
//   elastic_energy                     pN um, sum of E/2 int |X_ss|^2 ds

#include "observable/observable.hpp"
#include "observable/stored_fibers.hpp"

namespace asterflow {

Observables fiber_observables(StoredFibers const& fibers);

// Fractions of the fibers with a length in [i, i + 1) width, i = 0 ... n_bin - 1; the last bin has all longer ones too.
std::vector<double> length_distribution(StoredFibers const& fibers, double width, int n_bin);

}  // namespace asterflow

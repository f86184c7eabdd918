#pragma once
// Who does the arithmetic of a fast sum: the near and the far field over the points of an octree, on host threads with
// vector loops or in Kokkos's default execution space.

#include "backends/fast.hpp"
#include "backends/fast_tree.hpp"

namespace asterflow {

class FastParts {
 public:
  virtual ~FastParts() = default;

  // normals as given, empty for kernels without. Orders the points of the tree's leaves; the tree must outlive the
  // sums.
  virtual void set_points(Octree& tree, ConstPoints normals) = 0;

  // Adds the sum in units of the root's side, in the order of the tree.
  //   strengths [n_source], velocity [n_target]
  //   slopes    [n_target, 3]  its gradient, unless empty
  virtual void add(ConstPoints strengths, Points velocity, Points slopes) = 0;

  virtual std::size_t memory() const = 0;
};

using PartsMaker = std::unique_ptr<FastParts>(std::string_view kernel, FastParameters const& parameters,
                                              FastInstructions instructions);
PartsMaker make_host_parts;
PartsMaker make_device_parts;

}  // namespace asterflow

#pragma once
// Numbers of the fast summation that follow from the requested accuracy. See docs/summation.md.

#include <cstddef>
#include <string_view>

namespace asterflow {

struct FastParameters {
  double accuracy;
  double split_shape;       // c of the window that splits the kernel
  double band;              // wave numbers kept, times the cutoff
  double nodes_per_cutoff;  // grid nodes per cutoff length
  int width;                // nodes of the grid window
  double window_shape;      // its c
  double local_tolerance;   // of the polynomials of the local part
  bool single;              // pairs in float, and grids but for the sums of strengths on them
  bool sums_in_double;      // of strengths on the grids, see fast_loops.hpp
  int refinement_steps;     // of the reciprocal square root, beyond what its estimate always needs

  bool gradient = false;      // whether gradients will be asked for

  long capacity = 150;        // points of a leaf, mean of sources and targets; two or four times as many where cheaper
  double nodes_per_point;     // bounds the memory of a patch,
  double fewest_nodes;        // which may have so many in any case
  double batch_nodes = 1e6;   // of patches handled together, unless one alone is larger
  double max_nodes(std::size_t n_point) const;  // of one patch; n_point: mean of sources and targets
};

// For a relative error of `accuracy`, 1e-12 ... 1e-3, of the velocity and, where asked for, its gradient.
FastParameters fast_parameters(std::string_view kernel, double accuracy, bool gradient = false);

}  // namespace asterflow

// The inner loops of the fast summation for the instruction set the including file is compiled for. Everything
// is in unnamed namespaces, so that no code compiled for one instruction set can be linked into another.

#include "backends/fast_loops.hpp"
#include "kernels/dual.hpp"

#include "backends/fast_pack.inl"

#include "backends/fast_fourier.inl"
#include "backends/fast_grid.inl"
#include "backends/fast_columns.inl"

#include "backends/fast_rows.inl"

#include "backends/fast_forward.inl"
#include "backends/fast_inverse.inl"
#include "backends/fast_convolve.inl"

#include "backends/fast_pieces.inl"

#include "backends/fast_near.inl"
#include "backends/fast_near_outer.inl"

namespace asterflow {
namespace {

template <class Real>
FastLoops<Real> fast_loops() {
  constexpr int tile_y = lanes<Real> > 8 ? 2 * lanes<Real> : 16;
  return {lanes<Real>, near_polynomials<Real>, tile_y, forward<Real>, forward_scratch<Real>, convolve<Real>,
          convolve_scratch<Real>, x_inverse<Real>, inverse_scratch<Real>, interpolate<Real>, add_near<Real>, list_near};
}

}  // namespace
}  // namespace asterflow

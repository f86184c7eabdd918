#pragma once
// The inner loops of the fast summation, seen by the rest of the program as plain functions. Each instruction
// set is compiled in its own file with its own flags (fast_loops_portable.cpp, _avx2.cpp, _avx512.cpp) and chosen at
// run time. The views hold numbers and pointers only: no code of this header may be shared between those files.

#include <cstdint>

namespace asterflow {

enum class FastKernel { stokeslet, stresslet, rotlet, stokeslet_pressure, stresslet_pressure };

// A one-dimensional Fourier transform, see fast_fourier.hpp.
template <class Real>
struct LineView {
  int length = 0, n_radix = 0;
  int const* radices = nullptr;
  Real const* twiddles = nullptr;
};

// A grid window, see fast_grid.hpp.
template <class Real>
struct WindowView {
  int width = 0, padded = 0, degree = 0;
  Real const* coefficients = nullptr;  // [2, degree + 1, padded]: of the weights, of their slopes per node
  bool sums_in_double = false;         // strengths add up on the grid in double or, as exactly, in whole numbers
};

// Points of a patch by grid tile: indices index[begin[tile]] ... index[begin[tile + 1]]; column: of each, or null.
struct TileView {
  std::uint32_t const* index = nullptr;
  long const* begin = nullptr;
  std::uint32_t const* column = nullptr;
};

// Points of a tile whose windows lie within the same `nodes` nodes along x and, along y, within as few of the tile's groups of
// `rows_at_once` rows as possible.
struct PointColumn {
  static constexpr int nodes = 16, rows_at_once = 4;
};

// A patch, see fast_patch.hpp. Grids of velocity are [z, y, 3, x] over target_low ... target_high, rows of
// `velocity_row` numbers. The spectrum is [component, plane, kx, 2, y], rows of `spectrum_row` numbers that begin at node
// used_low[1]; node z is plane z - used_low[2].
template <class Real>
struct PatchView {
  int nodes[3];
  double corner[3], to_nodes;  // a window at x begins at node floor((x - corner) to_nodes) of the endless grid
  double scale, slope_scale;  // of velocities, and of their slopes per node
  int tile_y, tile_z, tiles_y, tiles_z;
  int target_low[3], target_high[3], source_low[3], source_high[3], used_low[3], used_high[3], planes;
  long velocity_row, spectrum_row;
  TileView sources, targets;
  float const* crowding;  // of each tile: no node's sum of weights is larger; null unless strengths add up with care
  int modes[3];
  int symbol_stride;
  double band;
  Real const* symbol;
  LineView<Real> lines[3];
};

// The polynomials of the local part for one level's cutoff, one on each of some equal pieces of r^2: for piece i, x = to_pieces r^2 -
// 1/2 within 1/2 of i, coefficients [term, piece] of (x - i)^term. A little below the cutoff nothing is left of the local part.
template <class Real>
struct NearLevel {
  static constexpr int max_coefficients = 128;
  Real cutoff2, to_pieces;
  alignas(64) Real a[max_coefficients], b[max_coefficients];
};

// Pieces, and terms of each that the loops are compiled for: fewest, fewest + step, ... most. has_outer: pairs far enough apart
// can be summed in float.
struct NearPolynomials {
  int pieces = 1, fewest = 0, step = 1, most = 0;
  bool has_outer = false;
};

// The whole local part in float between some distance and the cutoff, see OuterPart.
struct OuterLevel {
  static constexpr int pieces = 16, fewest = 5, most = 7;
  double to_cutoff;  // 1 / cutoff: unit of r below
  float to_pieces, shift;  // x = to_pieces r^2 + shift within 1/2 of i in piece i
  alignas(64) float first[most * pieces], second[most * pieces];
};

// Sources base + list[i] act at the cutoff of `level`, up to position `end` of the list. Their reactions are summed from
// place `reaction` of the leaf on; one_way: they have none.
struct NearSegment {
  static constexpr std::int32_t one_way = -1;
  std::uint32_t base, end;
  std::int32_t level, reaction;
};

// One vector of targets, and its segments up to segment_end; those of outer sources up to outer_end.
struct NearGroup {
  long target;
  int n_target;
  std::uint32_t segment_end, outer_end;
};

// The local part at the targets of one leaf.
template <class Real>
struct NearWork {
  FastKernel kernel;
  int terms, refinement_steps;  // of the polynomials of a piece; of 1 / r, see inverse_distance()
  NearLevel<Real> const* levels;
  Real const* records;  // [source, record]: coordinates (float: high and low parts), strength, normal
  int record;
  double const* targets;  // [target, 3]
  NearGroup const* groups;
  long n_group;
  NearSegment const* segments;
  std::uint16_t const* list;
  double velocity_scale, gradient_scale;
  Real* reactions;  // [place, 4], added to: three components and padding; null where all pairs are one way
  OuterLevel const* outer_levels;  // null where no sources are apart
  int outer_terms;
  NearSegment const* outer_segments;
  std::uint16_t const* outer_list;
};

// Which sources may lie within `reach` of a group of targets t, all in normalised float coordinates.
struct NearQuery {
  static constexpr int max_target = 32;
  static constexpr float touch = 1e-6f;  // distances below it may be rounding
  float const* sources[3];
  float middle[3], half[3];  // of the targets' box
  float targets[3][max_target], squares[max_target];  // 2 (t - middle), |t - middle|^2
  int n_target;
  float reach;
  float inner;  // sources farther from all targets are put apart, if in reach
};

// Sources whose local parts are summed before the sum goes to double: in float every term rounds the sum of those before it.
template <class Real>
inline constexpr long near_run = sizeof(Real) == 4 ? 32 : 1L << 40;

// Where a search for sources writes, with room for as many as are searched + NearQuery::max_target: the sources in reach
// and not put apart, the places among them of those that may touch a target, and the sources put apart.
struct NearFound {
  std::uint16_t *sources, *touching, *outer;
  long n_source = 0, n_touching = 0, n_outer = 0;
};

template <class Real>
struct FastLoops {
  int lanes = 0;  // numbers in a vector register

  NearPolynomials near_polynomials;

  int tile_y = 0;  // nodes of one tile of the grid

  // One tile of the grid: spreads strengths [source, components] and transforms the rows along x.
  // points [n, 3]. scratch: forward_scratch numbers, aligned to 64 bytes.
  void (*forward)(WindowView<Real> const&, PatchView<Real> const&, int components, long tile, double const* points,
                  Real const* strengths, Real* spectrum, Real* scratch) = nullptr;
  long (*forward_scratch)(WindowView<Real> const&, PatchView<Real> const&, int components) = nullptr;

  // The middle, for one kx: along z and y, multiplication by the symbol, back along y and z.
  void (*convolve)(PatchView<Real> const&, FastKernel kernel, int kx, Real* spectrum, Real* scratch) = nullptr;
  long (*convolve_scratch)(PatchView<Real> const&, int components) = nullptr;

  // Back along x for one plane z, into the velocity's grid.
  void (*x_inverse)(PatchView<Real> const&, int z, Real const* spectrum, Real* grid, Real* scratch) = nullptr;
  long (*inverse_scratch)(PatchView<Real> const&) = nullptr;

  // velocity [n, 3] += patch.scale * interpolated grid at the targets of one tile; likewise
  // gradient [n, 3, 3] (d velocity_i / d x_j in units of the root's side) unless null.
  void (*interpolate)(WindowView<Real> const&, PatchView<Real> const&, long tile, double const* points, Real const* grid,
                      double* velocity, double* gradient) = nullptr;

  // velocity [n, 3] += local part; likewise gradient [n, 3, 3] unless null.
  void (*add_near)(NearWork<Real> const&, double* velocity, double* gradient) = nullptr;

  // Writes s - base for the sources s in begin ... end - 1 that the query finds.
  void (*list_near)(NearQuery const&, long begin, long end, long base, NearFound& found) = nullptr;
};

// Call the loops only on a processor that has the instructions.
template <class Real>
FastLoops<Real> fast_loops_portable();
template <class Real>
FastLoops<Real> fast_loops_avx2();
template <class Real>
FastLoops<Real> fast_loops_avx512();

}  // namespace asterflow

#pragma once
// The pair loops of one instruction set, seen by the rest of the program as plain functions. Each
// instruction set is compiled in its own file with its own flags (pair_sums_avx2.cpp,
// pair_sums_avx512.cpp); nothing in this header may become code there that others could share.
//
// Layouts, for a vector register of `lanes` numbers and a kernel with S numbers per source:
//   lane group  [components, lanes]  `lanes` points side by side, one component after the other
//   record      [components]         one point
// Components of a target are its coordinates; those of a source its coordinates, strength (3) and, where the
// kernel has one, normal (3). Coordinates are those of frame.hpp.

namespace asterflow {

template <class Real>
struct PairSums {
  int lanes = 0;
  int steps = 0;       // terms that correct the hardware estimate of 1 / |r|
  double error = 0.0;  // bound of the relative error of 1 / |r|, rounding apart

  // velocity [n_group, 3, lanes] += sums over all sources.
  //   targets [n_group] lane groups that begin with coordinates, `stride` numbers from one to the next
  //   sources [n_source] records
  void (*add_one_way)(Real const* targets, long n_group, long stride, Real const* sources, long n_source,
                      double* velocity) = nullptr;

  // Rows act on columns and columns on rows; no point may be in both.
  //   rows [n_group] lane groups of sources, columns [n_column] records of sources
  //   n_column is a multiple of lanes, at most max_column; one record behind the last is read, and not used
  //   row_velocity [n_group, 3, lanes], column_velocity [n_column / lanes, 3, lanes], both added to
  void (*add_both_ways)(Real const* rows, long n_group, Real const* columns, long n_column, double* row_velocity,
                        double* column_velocity) = nullptr;
  static constexpr long max_column = 64;

  // gradient [n_group, 3, 3, lanes] += d velocity_i / d x_j at the targets; arguments as for add_one_way.
  void (*add_gradient)(Real const* targets, long n_group, long stride, Real const* sources, long n_source,
                       double* gradient) = nullptr;
};

// The loops of number i_kernel of AllSums (kernels/list.hpp) with the given number of correction steps; without
// functions when there are none. Call only on a processor that has the instructions.
template <class Real>
PairSums<Real> avx2_pair_sums(int i_kernel, int steps);
template <class Real>
PairSums<Real> avx512_pair_sums(int i_kernel, int steps);

}  // namespace asterflow

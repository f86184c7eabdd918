#pragma once
// All-pairs sums in one arithmetic with the pair loops of one instruction set: keeps points and strengths
// in the layouts of pair_sums.hpp and shares the work among host threads.
//
// When the sources appear among the targets, as a run in the same order, that part of the sum is done both
// ways at once: the run is cut into an even number of blocks, and a round-robin tournament (n_block - 1 rounds of
// n_block / 2 disjoint pairs of blocks) fixes the order in which every point collects its velocity. The blocks
// depend on the number of points alone, so results are the same bits for any number of threads.

#include "backends/frame.hpp"
#include "backends/pair_sums.hpp"

#include <Kokkos_Core.hpp>

namespace asterflow {

// Kernel constants, see kernels/kernel.hpp.
struct KernelTraits {
  int index = 0;  // in AllSums
  double prefactor = 1.0;
  int decay = 1;
  bool has_normal = false;
};

template <class Real>
class PackedSum {
 public:
  PackedSum(KernelTraits const& kernel, PairSums<Real> const& loops) : kernel_(kernel), loops_(loops) {}

  void set_points(ConstPoints sources, ConstPoints targets, ConstPoints normals, Frame const& frame);
  void add_velocity(ConstPoints strengths, Points velocity);
  void add_gradient(ConstPoints strengths, Points gradient);  // [3 n_target, 3]
  std::size_t memory() const;

 private:
  // Growing array of numbers aligned for vector registers.
  template <class Number>
  using Numbers = Kokkos::View<Number*, Kokkos::HostSpace>;

  struct Block {
    long first_group, n_group;
  };

  void set_blocks();
  void pack_strengths(ConstPoints strengths);
  void sum_one_way();
  void sum_both_ways();
  void sum_block_pair(Block const& rows, Block const& columns);
  long n_numbers() const { return n_coordinates<Real> + (kernel_.has_normal ? 6 : 3); }

  KernelTraits kernel_;
  PairSums<Real> loops_;
  Frame frame_;
  long n_source_ = 0, n_target_ = 0;
  long first_self_ = 0, n_self_ = 0;  // targets first_self_ ... first_self_ + n_self_ - 1 are the sources
  long n_part_ = 1;               // of the sources, summed apart where other targets are few
  double strength_unit_ = 1.0;
  std::vector<Block> blocks_;     // of the sources, for the sum both ways
  Numbers<Real> records_;         // [sources, padded to whole groups, and one][n_numbers]
  Numbers<Real> rows_;            // [groups of sources][n_numbers, lanes], when n_self_ > 0
  Numbers<Real> targets_;         // [groups of other targets][n_coordinates, lanes]
  Numbers<double> row_velocity_;     // [groups of sources][3, lanes]
  Numbers<double> target_velocity_;  // [groups of other targets][3, lanes]
};

}  // namespace asterflow

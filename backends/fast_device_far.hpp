#pragma once
// The smooth part of a split kernel in Kokkos's default execution space: every patch spread, convolved by Fourier
// transforms and interpolated. Which patches there are is the business of fast_patches.hpp.

#include "backends/fast_device_patch.hpp"

namespace asterflow {

template <class Real>
class DeviceFar {
 public:
  DeviceFar(FastKernel kernel, FastParameters const& parameters);

  // normals [n_source] in the order of the tree, empty for kernels without.
  void set_points(Octree const& tree, ConstPoints normals);

  // velocity [n_target, 3] += smooth part in units of the root's side, but for uniform_flow(), tree order; slopes
  // [n_target, 3, 3] likewise, unless empty. strengths [n_source, 3].
  void add(DeviceArray<double> const& strengths, DeviceArray<double> const& velocity, DeviceArray<double> const& slopes);
  Vec3d uniform_flow(ConstPoints strengths) const { return patches_.uniform_flow(strengths); }

  std::size_t memory() const;

  void put_strengths(DeviceArray<double> const& strengths) const;

 private:
  // The pieces of every phase, for patches handled together.
  struct Batch {
    DevicePieces blocks, rows, y_lines, z_lines, modes, z_lines_back, y_lines_back, rows_back, targets;
  };

  void send_patches();
  DeviceLine line(int length, std::vector<Real>& twiddles);
  void add_batch(std::size_t first, std::size_t last);
  template <class Count>
  DevicePieces pieces(std::size_t first, std::size_t last, int components, Count const& count) const;
  void run(Batch const& batch, DeviceArray<double> const& velocity, DeviceArray<double> const& slopes) const;

  FastKernel kernel_;
  int components_;
  FarPatches<Real> patches_;
  long n_source_ = 0;
  std::vector<DevicePatch> host_patches_;
  std::vector<Batch> batches_;
  DeviceArray<double> normals_;
  DeviceTables<Real> tables_;
};

extern template class DeviceFar<float>;
extern template class DeviceFar<double>;

}  // namespace asterflow

#pragma once
// The local part of a split kernel in Kokkos's default execution space: one target per thread, the targets of a group side
// by side with one list of sources.

#include "backends/fast_device_space.hpp"
#include "backends/fast_near_lists.hpp"
#include "backends/fast_split.hpp"

namespace asterflow {

// Where the list of a group of targets begins, in numbers of segments.
struct DeviceGroup {
  long target, segment_begin, segment_end;
  int n_target;
};

// Sources base + list[i] for i in [begin, end) act at the cutoff of `level`.
struct DeviceSegment {
  long begin, end;
  std::uint32_t base;
  int level;
};

// The polynomials of the local part, for cutoff 1, passed by value: every thread reads the same number.
template <class Real>
struct DevicePolynomials {
  static constexpr int max_terms = 24;
  int terms = 0;
  Real a[max_terms] = {}, b[max_terms] = {};
};

// What a level's cutoff makes of them: x = x_scale r^2 - 1/2, A and B times a_scale and b_scale.
template <class Real>
struct DeviceLevel {
  Real cutoff2, x_scale, a_scale, b_scale;
};

template <class Real>
class DeviceNear {
 public:
  DeviceNear(FastKernel kernel, LocalPart const& local);

  // only_close: the pairs that the lists set apart instead of all others.
  void set_points(NearLists const& lists, bool only_close, ConstPoints normals);
  bool is_empty() const { return n_group_ == 0; }

  // velocity [n_target, 3] += the local part in units of the root's side; slopes [n_target, 3, 3] likewise, unless
  // empty. strengths [n_source, 3].
  void add(DeviceArray<double> const& strengths, DeviceArray<double> const& velocity, DeviceArray<double> const& slopes);

  std::size_t memory() const;

  template <class Kernel>
  void add_of(DeviceArray<double> const& velocity, DeviceArray<double> const& slopes) const;
  void put_strengths(DeviceArray<double> const& strengths) const;

 private:
  void list(NearLists const& lists);
  void list_close(NearLists const& lists);
  void send_points(NearLists const& lists, ConstPoints normals);

  FastKernel kernel_;
  DevicePolynomials<Real> polynomials_;
  int record_;  // numbers per source: coordinates (float: high and low parts), strength, normal
  int group_size_ = 1;
  long n_source_ = 0, n_group_ = 0;
  double scale_ = 1.0, side_ = 1.0;
  DeviceArray<DeviceLevel<Real>> levels_;
  DeviceArray<DeviceGroup> groups_;
  DeviceArray<DeviceSegment> segments_;
  DeviceArray<std::uint16_t> list_;
  DeviceArray<Real> records_, targets_;
};

extern template class DeviceNear<float>;
extern template class DeviceNear<double>;

}  // namespace asterflow

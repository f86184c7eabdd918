// The parts of a fast sum in Kokkos's default execution space. Octree, lists and patches are made on the host, as for host
// threads, and copied once per geometry.

#include "backends/backend.hpp"
#include "backends/fast_device_far.hpp"
#include "backends/fast_device_near.hpp"
#include "backends/fast_instructions.hpp"
#include "backends/fast_kernel.hpp"
#include "backends/fast_parts.hpp"

namespace asterflow {
namespace {

// Targets that share a list of sources: those of a warp.
constexpr int group_size = default_space_is_host ? 8 : 32;

template <class NearReal, class FarReal>
class DeviceParts final : public FastParts {
  static constexpr bool near_in_float = sizeof(NearReal) == 4;

 public:
  DeviceParts(std::string_view kernel, FastParameters const& parameters, LocalPart const& local, FastInstructions instructions)
      : lists_(group_size, near_in_float, fast_loops_of<NearReal>(instructions).list_near),
        near_(fast_kernel(kernel), local),
        close_(fast_kernel(kernel), local),
        far_(fast_kernel(kernel), parameters) {}

  void set_points(Octree& tree, ConstPoints normals) override {
    lists_.set_points(tree, false);
    PointArray const sorted = tree.sorted(normals);
    near_.set_points(lists_, false, sorted);
    close_.set_points(lists_, true, sorted);
    far_.set_points(tree, sorted);
  }

  void add(ConstPoints strengths, Points velocity, Points slopes) override {
    send(strengths_, &strengths.data()->x, 3 * strengths.size(), "strengths");
    send(velocity_, &velocity.data()->x, 3 * velocity.size(), "velocity");
    slopes_ = {};
    if (!slopes.empty()) send(slopes_, &slopes.data()->x, 3 * slopes.size(), "slopes");
    near_.add(strengths_, velocity_, slopes_);
    close_.add(strengths_, velocity_, slopes_);
    far_.add(strengths_, velocity_, slopes_);
    fetch(velocity_, velocity);
    fetch(slopes_, slopes);
    Vec3d const uniform = far_.uniform_flow(strengths);
    for (Vec3d& u : velocity) u += uniform;
  }

  std::size_t memory() const override {
    return lists_.memory() + near_.memory() + close_.memory() + far_.memory() +
           sizeof(double) * (strengths_.size() + velocity_.size() + slopes_.size());
  }

 private:
  // Waits for what was launched: the host reads the result.
  static void fetch(DeviceArray<double> const& array, Points points) {
    if (points.empty()) return;
    Kokkos::View<double*, Kokkos::HostSpace, Kokkos::MemoryUnmanaged> const here(&points.data()->x, 3 * points.size());
    Kokkos::deep_copy(here, Kokkos::subview(array, std::make_pair(std::size_t{0}, 3 * points.size())));
  }

  NearLists lists_;
  DeviceNear<NearReal> near_;
  DeviceNear<double> close_;  // pairs too close for float coordinates
  DeviceFar<FarReal> far_;
  DeviceArray<double> strengths_, velocity_, slopes_;  // of the last sum
};

FastInstructions host_instructions() {
  return has_avx512() ? FastInstructions::avx512 : has_avx2() ? FastInstructions::avx2 : FastInstructions::portable;
}

}  // namespace

std::unique_ptr<FastParts> make_device_parts(std::string_view kernel, FastParameters const& parameters, FastInstructions) {
  auto const local = KernelSplit(parameters.split_shape).local_part(kernel, parameters.local_tolerance, 1);
  if (parameters.single && parameters.sums_in_double)  // one precision for all of a grid here
    return std::make_unique<DeviceParts<float, double>>(kernel, parameters, local, host_instructions());
  if (parameters.single) return std::make_unique<DeviceParts<float, float>>(kernel, parameters, local, host_instructions());
  return std::make_unique<DeviceParts<double, double>>(kernel, parameters, local, host_instructions());
}

}  // namespace asterflow

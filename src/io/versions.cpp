#include "io/versions.hpp"

#include "base/build_info.hpp"
#include "base/parallel.hpp"

#include <Eigen/Core>
#include <fmt/format.h>

namespace asterflow {

std::string program_version() { return build_info::version; }

std::string all_versions() {
  return fmt::format("asterflow {}, Kokkos {}, HDF5 {}, Eigen {}.{}.{}, compiler {}", program_version(),
                     kokkos_version(), build_info::hdf5_version, EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION, __VERSION__);
}

}  // namespace asterflow

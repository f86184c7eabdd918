#include "io/versions.hpp"

#include <Eigen/Core>
#include <Kokkos_Core.hpp>
#include <fmt/format.h>

namespace asterflow {

std::string program_version() { return ASTERFLOW_VERSION; }

std::string all_versions() {
  return fmt::format("asterflow {}, Kokkos {}.{}.{}, HDF5 {}, Eigen {}.{}.{}, compiler {}", program_version(),
                     KOKKOS_VERSION / 10000, KOKKOS_VERSION / 100 % 100, KOKKOS_VERSION % 100, ASTERFLOW_HDF5_VERSION,
                     EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION, __VERSION__);
}

}  // namespace asterflow

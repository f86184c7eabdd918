#include "io/versions.hpp"

#include "base/parallel.hpp"

#include <Eigen/Core>
#include <fmt/format.h>

namespace asterflow {

std::string program_version() { return ASTERFLOW_VERSION; }

std::string all_versions() {
  return fmt::format("asterflow {}, Kokkos {}, HDF5 {}, Eigen {}.{}.{}, compiler {}", program_version(),
                     kokkos_version(), ASTERFLOW_HDF5_VERSION, EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION, __VERSION__);
}

}  // namespace asterflow

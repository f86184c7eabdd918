#pragma once
// What wrote a result.

#include <string>

namespace asterflow {

std::string program_version();  // "0.1.0"
std::string all_versions();     // "asterflow 0.1.0, Kokkos ..., HDF5 ..., Eigen ..., compiler ..."

}  // namespace asterflow

# Every library is found, never downloaded; cmake/bootstrap.sh installs them.
if(DEFINED ENV{XDG_CACHE_HOME})
  set(kokkos_cache $ENV{XDG_CACHE_HOME}/asterflow/kokkos)
else()
  set(kokkos_cache $ENV{HOME}/.cache/asterflow/kokkos)
endif()
find_package(Kokkos REQUIRED HINTS ${kokkos_cache})  # Kokkos_ROOT first, then what bootstrap built, then the system
if(ASTERFLOW_DEVICE AND NOT ASTERFLOW_DEVICE IN_LIST Kokkos_DEVICES)
  message(FATAL_ERROR "ASTERFLOW_DEVICE is ${ASTERFLOW_DEVICE}, but the Kokkos in ${Kokkos_DIR} is for ${Kokkos_DEVICES}: "
    "let Kokkos_ROOT in the environment name the folder of one for ${ASTERFLOW_DEVICE}")
endif()
find_package(Eigen3 3.3 REQUIRED NO_MODULE)
find_package(PkgConfig REQUIRED)
pkg_check_modules(FFTW REQUIRED IMPORTED_TARGET fftw3)
find_package(HDF5 REQUIRED COMPONENTS C)
target_compile_definitions(hdf5::hdf5 INTERFACE H5_USE_110_API)  # the oldest we build with; newer ones offer it too
find_package(tomlplusplus REQUIRED)
find_package(CLI11 REQUIRED)
find_package(fmt REQUIRED)
if(CMAKE_CXX_COMPILER MATCHES "nvcc_wrapper")  # fmt 9 takes half of its constexpr away there
  set_property(TARGET fmt::fmt APPEND PROPERTY INTERFACE_COMPILE_DEFINITIONS FMT_USE_CONSTEXPR=1)
endif()
find_package(spdlog REQUIRED)
if(ASTERFLOW_BUILD_TESTS)
  find_package(GTest REQUIRED)
endif()
if(ASTERFLOW_BUILD_BENCH)
  find_package(benchmark REQUIRED)
endif()

# What another project can build on: find_package(asterflow), then link asterflow::backends
# (pair sums, backends/evaluator.hpp; with it the pointwise kernels and base).
include(CMakePackageConfigHelpers)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/asterflow)

set_target_properties(asterflow_base PROPERTIES EXPORT_NAME base)
set_target_properties(asterflow_backends PROPERTIES EXPORT_NAME backends)
install(TARGETS asterflow_base asterflow_backends EXPORT asterflowTargets)
install(TARGETS asterflow)
install(DIRECTORY scripts/ DESTINATION ${CMAKE_INSTALL_DATADIR}/asterflow USE_SOURCE_PERMISSIONS
  FILES_MATCHING PATTERN "plot_*.py")  # its pictures
install(DIRECTORY scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/asterflow)
install(EXPORT asterflowTargets NAMESPACE asterflow:: DESTINATION ${package_folder})

set(include_folder ${CMAKE_INSTALL_INCLUDEDIR}/asterflow)
install(FILES backends/evaluator.hpp DESTINATION ${include_folder}/backends)
install(DIRECTORY kernels DESTINATION ${include_folder} FILES_MATCHING PATTERN "*.hpp")
install(DIRECTORY src/base DESTINATION ${include_folder} FILES_MATCHING PATTERN "*.hpp"
  PATTERN "table.hpp" EXCLUDE)  # scene files are read by the program, not by the library

configure_package_config_file(cmake/asterflowConfig.cmake.in asterflowConfig.cmake
  INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(asterflowConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/asterflowConfig.cmake ${PROJECT_BINARY_DIR}/asterflowConfigVersion.cmake
  DESTINATION ${package_folder})

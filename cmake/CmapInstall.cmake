# The installed package: find_package(cmap) gives cmap::core, io, spatial, metrics, align, eval and report,
# and, where Ceres was found, graph and recon.
include(CMakePackageConfigHelpers)

set(CMAP_INSTALL_CMAKEDIR ${CMAKE_INSTALL_LIBDIR}/cmake/cmap)

install(DIRECTORY include/cmap DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.hpp" PATTERN render EXCLUDE PATTERN gl EXCLUDE PATTERN sim EXCLUDE)
install(FILES ${PROJECT_BINARY_DIR}/include/cmap/core/version.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/cmap/core)
install(DIRECTORY configs DESTINATION ${CMAKE_INSTALL_DATADIR}/cmap)

install(EXPORT cmapTargets NAMESPACE cmap:: DESTINATION ${CMAP_INSTALL_CMAKEDIR})
configure_package_config_file(cmake/cmapConfig.cmake.in ${PROJECT_BINARY_DIR}/cmapConfig.cmake
  INSTALL_DESTINATION ${CMAP_INSTALL_CMAKEDIR} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/cmapConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/cmapConfig.cmake ${PROJECT_BINARY_DIR}/cmapConfigVersion.cmake
  DESTINATION ${CMAP_INSTALL_CMAKEDIR})

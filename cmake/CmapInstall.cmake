# What is installed, in two parts: `programs`, and `development` for find_package(cmap), with the modules that this build
# has: cmap::core, geometry, io, spatial, metrics, align, peers, eval, report and board, and, where Ceres was found, graph, lio, colorize and recon.
# The libraries are static.
include(CMakePackageConfigHelpers)

set(CMAP_INSTALL_CMAKEDIR ${CMAKE_INSTALL_LIBDIR}/cmake/cmap)
get_property(CMAP_MODULES GLOBAL PROPERTY CMAP_MODULES)
get_property(CMAP_PROGRAMS GLOBAL PROPERTY CMAP_PROGRAMS)

# Headers of modules alone; without those of libraries that are not installed.
foreach(module IN LISTS CMAP_MODULES)
  install(DIRECTORY include/cmap/${module} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/cmap COMPONENT development
    FILES_MATCHING PATTERN "*.hpp" PATTERN image_file.hpp EXCLUDE PATTERN "*recording.hpp" EXCLUDE PATTERN figure_module.hpp EXCLUDE)
endforeach()
foreach(made core/version.hpp metrics/catalog.hpp)
  get_filename_component(folder ${made} DIRECTORY)
  install(FILES ${PROJECT_BINARY_DIR}/include/cmap/${made} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/cmap/${folder}
    COMPONENT development)
endforeach()
install(DIRECTORY configs DESTINATION ${CMAKE_INSTALL_DATADIR}/cmap COMPONENT programs)

install(EXPORT cmapTargets NAMESPACE cmap:: DESTINATION ${CMAP_INSTALL_CMAKEDIR} COMPONENT development)
configure_package_config_file(cmake/cmapConfig.cmake.in ${PROJECT_BINARY_DIR}/cmapConfig.cmake
  INSTALL_DESTINATION ${CMAP_INSTALL_CMAKEDIR} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/cmapConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/cmapConfig.cmake ${PROJECT_BINARY_DIR}/cmapConfigVersion.cmake
  DESTINATION ${CMAP_INSTALL_CMAKEDIR} COMPONENT development)

file(RELATIVE_PATH CMAP_PREFIX_FROM_PC /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(cmake/cmap.pc.in ${PROJECT_BINARY_DIR}/cmap.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/cmap.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)

# Manual pages from --help, and completion of options in bash.
find_program(CMAP_HELP2MAN help2man)
foreach(program IN LISTS CMAP_PROGRAMS)
  install(FILES cmake/bash_completion DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
    RENAME ${program} COMPONENT programs)
  if(CMAP_HELP2MAN)
    set(page ${PROJECT_BINARY_DIR}/man/${program}.1)
    add_custom_command(OUTPUT ${page} DEPENDS ${program}
      COMMAND ${CMAKE_COMMAND} -E make_directory ${PROJECT_BINARY_DIR}/man
      COMMAND ${CMAP_HELP2MAN} --no-info --no-discard-stderr --output ${page} $<TARGET_FILE:${program}>)
    list(APPEND man_pages ${page})
  endif()
endforeach()
if(man_pages)
  add_custom_target(man ALL DEPENDS ${man_pages})
  install(FILES ${man_pages} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT programs)
endif()

# cpack -G DEB: cmap (programs) and libcmap-dev.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME cmap)
set(CPACK_PACKAGE_CONTACT "The cmap authors <cmap@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL programs development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_NAME cmap)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libcmap-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libeigen3-dev, libfmt-dev, libtbb-dev, libssl-dev, zlib1g-dev, nlohmann-json3-dev, liblzf-dev, liblz4-dev")
include(CPack)

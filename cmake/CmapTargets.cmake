# How cmap's own targets are made: modules, programs and tests.

# Warnings and floating-point rules of every target of ours.
function(cmap_set_compile_options target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  # Fused multiply-adds would make results depend on the instruction set.
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wconversion -Wshadow -ffp-contract=off)
  if(CMAP_WARNINGS_AS_ERRORS)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()

# cmap_add_library(name SOURCES a.cpp ... [PUBLIC lib ...] [PRIVATE lib ...]) makes cmap::<name>, for our own programs. It sees
# the public headers of all modules and the private ones of its own folder.
function(cmap_add_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  # Programs are called cmap_<name>; some share their name with a module.
  set(target cmap_lib_${name})
  add_library(${target} ${ARG_SOURCES})
  add_library(cmap::${name} ALIAS ${target})
  cmap_set_compile_options(${target})
  target_include_directories(${target}
    PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
    PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
  target_link_libraries(${target} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} OUTPUT_NAME cmap_${name}
    POSITION_INDEPENDENT_CODE ON)
endfunction()

# The same for a module that is installed for others to use.
function(cmap_add_module name)
  cmap_add_library(${name} ${ARGN})
  install(TARGETS cmap_lib_${name} EXPORT cmapTargets COMPONENT development)
  set_property(GLOBAL APPEND PROPERTY CMAP_MODULES ${name})
endfunction()

# cmap_add_kernels(module LEVELS level ... [OPTIONS option ...]) adds simd/kernels_<level>.cpp to a module, one translation unit for
# each instruction set of this processor family; which one runs is decided at start-up (core/simd.hpp).
function(cmap_add_kernels module)
  cmake_parse_arguments(ARG "" "" "LEVELS;OPTIONS" ${ARGN})
  set(options_avx2 -mavx2 -mfma)
  # Eigen wants -mfma beside AVX-512; GCC 12 warns of its own min and max intrinsics (GCC bug 105593).
  set(options_avx512 -mfma -mavx512f -mavx512dq -mavx512bw -mavx512vl -mprefer-vector-width=512
    -Wno-maybe-uninitialized -Wno-uninitialized)
  foreach(level IN LISTS ARG_LEVELS)
    if(level STREQUAL plain OR CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
      set(source simd/kernels_${level}.cpp)
      target_sources(cmap_lib_${module} PRIVATE ${source})
      set_source_files_properties(${source} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON
        COMPILE_OPTIONS "${ARG_OPTIONS};${options_${level}}")
    endif()
  endforeach()
endfunction()

# cmap_add_loaded_module(name SOURCES a.cpp ... LIBRARIES lib ...) makes a shared library that programs load when it is asked for
# (cmap/core/loaded_module.hpp); only its entry point is visible.
function(cmap_add_loaded_module name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBRARIES" ${ARGN})
  add_library(${name} MODULE ${ARG_SOURCES})
  cmap_set_compile_options(${name})
  target_include_directories(${name} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
  target_link_libraries(${name} PRIVATE ${ARG_LIBRARIES})
  set(symbols ${PROJECT_SOURCE_DIR}/cmake/loaded_module.map)
  target_link_options(${name} PRIVATE -Wl,--version-script=${symbols})
  set_property(TARGET ${name} APPEND PROPERTY LINK_DEPENDS ${symbols})
endfunction()

# cmap_list_objects(PREFIX type namespace name ...) sets <PREFIX>_DECLARATIONS and <PREFIX>_POINTERS, the text of C++ that
# declares objects of one type in namespace cmap::<namespace> and lists their addresses. A list in CMake decides what there is:
# objects of a static library that registered themselves would be left out by the linker.
function(cmap_list_objects prefix type namespace)
  set(declarations "")
  set(pointers "")
  foreach(name IN LISTS ARGN)
    string(APPEND declarations "extern const ${type} ${name};\n")
    string(APPEND pointers "      &${namespace}::${name},\n")
  endforeach()
  set(${prefix}_DECLARATIONS "${declarations}" PARENT_SCOPE)
  set(${prefix}_POINTERS "${pointers}" PARENT_SCOPE)
endfunction()

# cmap_require_tests(what name ...): each name of a list has a <name>_test.cpp in this folder.
function(cmap_require_tests what)
  foreach(name IN LISTS ARGN)
    if(NOT EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/${name}_test.cpp)
      file(RELATIVE_PATH test ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR}/${name}_test.cpp)
      message(FATAL_ERROR "the ${what} ${name} has no test: write ${test}")
    endif()
  endforeach()
endfunction()

# cmap_add_tests(module name ...) adds each <name>_test.cpp of this folder to the program tests_<module>, one link for all of
# them, and makes the CTest test "<module>/<name>" of it.
function(cmap_add_tests module)
  set(target tests_${module})
  if(NOT TARGET ${target})
    add_executable(${target})
    cmap_set_compile_options(${target})
    target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/tests ${PROJECT_SOURCE_DIR}/lib/${module})
    target_link_libraries(${target} PRIVATE cmap::${module} cmap_test_main)
    # Headers are what compiling tests costs: several files at once, each with a namespace of its own, and little optimized.
    set_target_properties(${target} PROPERTIES UNITY_BUILD_BATCH_SIZE 6)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  endif()
  foreach(name IN LISTS ARGN)
    target_sources(${target} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/${name}_test.cpp)
    add_test(NAME ${module}/${name} COMMAND ${target} ${name})
    set_tests_properties(${module}/${name} PROPERTIES TIMEOUT 600 SKIP_REGULAR_EXPRESSION "\\[  PASSED  \\] 0 tests"
      ENVIRONMENT "CMAP_SOURCE_DIR=${PROJECT_SOURCE_DIR};CMAP_BINARY_DIR=${PROJECT_BINARY_DIR}")
  endforeach()
endfunction()

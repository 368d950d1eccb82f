# Run by CTest, which sets the variables: see CMakeLists.txt.
cmake_minimum_required(VERSION 3.22)

set(work ${CMAP_BINARY_DIR}/package_test)
set(prefix ${work}/prefix)
file(REMOVE_RECURSE ${work})

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "${ARGN} ended with ${code}:\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

function(expect_output pattern)
  if(NOT output MATCHES "${pattern}")
    message(FATAL_ERROR "\"${pattern}\" expected in:\n${output}")
  endif()
endfunction()

run(${CMAKE_COMMAND} --install ${CMAP_BINARY_DIR} --prefix ${prefix} --config ${CONFIG})

# A package that names folders of the machine that built it would break elsewhere.
file(GLOB_RECURSE scripts ${prefix}/*.cmake)
foreach(script IN LISTS scripts)
  file(READ ${script} text)
  foreach(folder "${CMAP_SOURCE_DIR}/" /usr/lib /usr/include)
    string(FIND "${text}" "${folder}" place)
    if(NOT place EQUAL -1)
      message(FATAL_ERROR "${script} names ${folder}")
    endif()
  endforeach()
endforeach()

# Every header that is installed compiles in the consumer, and has its library.
file(GLOB_RECURSE headers RELATIVE ${prefix}/include ${prefix}/include/*.hpp)
foreach(header cmap/core/version.hpp cmap/metrics/catalog.hpp cmap/report/report.hpp)
  if(NOT header IN_LIST headers)
    message(FATAL_ERROR "${header} is not installed")
  endif()
endforeach()
list(FILTER headers INCLUDE REGEX "/(render|gl|sim)/|image_file|figure_module")
if(headers)
  message(FATAL_ERROR "headers without their libraries: ${headers}")
endif()
file(GLOB_RECURSE headers RELATIVE ${prefix}/include ${prefix}/include/*.hpp)
foreach(header IN LISTS headers)
  string(APPEND includes "#include \"${header}\"\n")
endforeach()
file(WRITE ${work}/all_headers.cpp "${includes}")

foreach(preset paper indoor outdoor aerial mapeval)
  if(NOT EXISTS ${prefix}/share/cmap/configs/${preset}.json)
    message(FATAL_ERROR "configs/${preset}.json is not installed")
  endif()
endforeach()

run(${CMAKE_COMMAND} -S ${CMAP_SOURCE_DIR}/tests/package/consumer -B ${work}/build -G ${GENERATOR}
  -DCMAKE_BUILD_TYPE=${CONFIG} -DCMAKE_CXX_COMPILER=${CXX_COMPILER} "-DCMAKE_CXX_FLAGS=${CXX_FLAGS}"
  "-DCMAKE_EXE_LINKER_FLAGS=${LINKER_FLAGS}" -DCMAKE_PREFIX_PATH=${prefix} -DALL_HEADERS=${work}/all_headers.cpp -DLIBRARY_EXAMPLE=${CMAP_SOURCE_DIR}/docs/library_example.cpp
  -DCMAP_VERSION=${CMAP_VERSION} -DCMAKE_RUNTIME_OUTPUT_DIRECTORY=${work}/bin)
run(${CMAKE_COMMAND} --build ${work}/build --config ${CONFIG})

set(identical ${CMAP_SOURCE_DIR}/data_samples/micro/identical)
file(GLOB_RECURSE consumer ${work}/bin/consumer)
file(GLOB_RECURSE eval_only ${work}/bin/eval_only)
run(${consumer})
expect_output("LCR +↑ +100.00 %")
run(${eval_only} ${identical}/reference.ply ${identical}/estimate.ply)
file(GLOB_RECURSE library_example ${work}/bin/library_example)
run(${library_example} ${identical}/reference.ply ${identical}/estimate.ply)
expect_output("Chamfer 0 m\nfitness within 0.1 m: 1")
run(${prefix}/bin/cmap_eval --version)
expect_output("cmap_eval ${CMAP_VERSION}")
run(${prefix}/bin/cmap_eval ${identical}/reference.ply ${identical}/estimate.ply
  --config ${prefix}/share/cmap/configs/indoor.json)
expect_output("LCR +↑ +100.00 %")
message(STATUS "installed, found, linked and run")

# The installed program finds its module for figures, where that was built.
file(GLOB_RECURSE figure_module ${prefix}/libcmap_figure.so)
if(figure_module)
  run(${prefix}/bin/cmap_eval ${identical}/reference.ply ${identical}/estimate.ply --figure ${work}/figure.png)
  if(NOT EXISTS ${work}/figure.png)
    message(FATAL_ERROR "no figure")
  endif()
endif()

# The same by pkg-config, for those who build without CMake.
find_program(pkg_config pkg-config)
if(pkg_config)
  file(GLOB_RECURSE package_file ${prefix}/*/cmap.pc)
  get_filename_component(package_folder ${package_file} DIRECTORY)
  set(ENV{PKG_CONFIG_PATH} ${package_folder})
  execute_process(COMMAND ${pkg_config} --static --cflags --libs cmap
    OUTPUT_VARIABLE flags RESULT_VARIABLE code OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "pkg-config does not find cmap")
  endif()
  separate_arguments(flags UNIX_COMMAND "${CXX_FLAGS} ${LINKER_FLAGS} -std=c++20 ${CMAP_SOURCE_DIR}/docs/library_example.cpp ${flags}")
  run(${CXX_COMPILER} ${flags} -o ${work}/by_pkg_config)
  run(${work}/by_pkg_config ${identical}/reference.ply ${identical}/estimate.ply)
  expect_output("Chamfer 0 m")
endif()

# Every library of the product, each a Debian package; the package is named where the library is missing.

function(cmap_require package debian_package)
  find_package(${package} ${ARGN} QUIET)
  if(NOT ${package}_FOUND)
    message(FATAL_ERROR "cmap needs ${package}: apt-get install ${debian_package} (tools/install_dependencies.sh installs everything)")
  endif()
endfunction()

macro(cmap_find_dependencies)
  cmap_require(Eigen3 libeigen3-dev 3.3 NO_MODULE)
  cmap_require(fmt libfmt-dev)
  cmap_require(TBB libtbb-dev)
  cmap_require(OpenSSL libssl-dev COMPONENTS Crypto)
  cmap_require(ZLIB zlib1g-dev)
  cmap_require(nlohmann_json nlohmann-json3-dev)
  cmap_require(CLI11 libcli11-dev)
endmacro()
cmap_find_dependencies()

# Packages without CMake files of their own.
find_path(CMAP_LZF_INCLUDE_DIR lzf.h PATH_SUFFIXES liblzf)
find_library(CMAP_LZF_LIBRARY lzf)
find_path(CMAP_FLANN_INCLUDE_DIR flann/flann.hpp)
find_library(CMAP_LZ4_LIBRARY lz4)
foreach(pair "LZF_INCLUDE_DIR;liblzf-dev" "LZF_LIBRARY;liblzf-dev" "FLANN_INCLUDE_DIR;libflann-dev" "LZ4_LIBRARY;liblz4-dev")
  list(GET pair 0 variable)
  list(GET pair 1 debian_package)
  if(NOT CMAP_${variable})
    message(FATAL_ERROR "cmap needs ${debian_package}: apt-get install ${debian_package}")
  endif()
endforeach()

# PCL, a peer in the benchmarks, uses more of VTK than figures do: whoever comes first decides in which folder VTK's
# targets live, and all of them must live here.
if(CMAP_BUILD_BENCHMARKS)
  find_package(PCL QUIET COMPONENTS kdtree io registration filters)
endif()

# Figures: optional. VTK's OpenGL and windows are for module gl alone.
find_package(VTK 9.1 QUIET COMPONENTS CommonDataModel IOImage RenderingCore RenderingFreeType
  OPTIONAL_COMPONENTS InteractionStyle RenderingOpenGL2 RenderingUI glew)
find_package(OpenGL QUIET COMPONENTS EGL GLX)
find_package(X11 QUIET)
find_path(CMAP_OPENCV_INCLUDE_DIR opencv2/imgproc.hpp PATH_SUFFIXES opencv4)
find_library(CMAP_OPENCV_CORE_LIBRARY opencv_core)
find_library(CMAP_OPENCV_IMGPROC_LIBRARY opencv_imgproc)
if(VTK_FOUND AND CMAP_OPENCV_INCLUDE_DIR AND CMAP_OPENCV_CORE_LIBRARY AND CMAP_OPENCV_IMGPROC_LIBRARY)
  set(CMAP_WITH_RENDER ON)
else()
  set(CMAP_WITH_RENDER OFF)
endif()
if(CMAP_WITH_RENDER AND TARGET VTK::RenderingOpenGL2 AND TARGET VTK::RenderingUI AND TARGET VTK::InteractionStyle AND TARGET VTK::glew
   AND TARGET OpenGL::EGL AND TARGET OpenGL::GLX AND TARGET X11::X11)
  set(CMAP_WITH_GL ON)
else()
  set(CMAP_WITH_GL OFF)
endif()

# Photographs of a capture: optional.
find_library(CMAP_OPENCV_IMGCODECS_LIBRARY opencv_imgcodecs)
if(CMAP_OPENCV_INCLUDE_DIR AND CMAP_OPENCV_CORE_LIBRARY AND CMAP_OPENCV_IMGPROC_LIBRARY AND CMAP_OPENCV_IMGCODECS_LIBRARY)
  set(CMAP_WITH_IMAGES ON)
else()
  set(CMAP_WITH_IMAGES OFF)
endif()

# Global registration: optional. PCL's own CMake files would bring in VTK and all its other modules.
find_path(CMAP_PCL_INCLUDE_DIR pcl/features/fpfh_omp.h PATH_SUFFIXES pcl-1.15 pcl-1.14 pcl-1.13 pcl-1.12)
set(CMAP_PCL_LIBRARIES)
set(CMAP_WITH_PCL ON)
foreach(module features search kdtree octree common)
  find_library(CMAP_PCL_${module}_LIBRARY pcl_${module})
  list(APPEND CMAP_PCL_LIBRARIES ${CMAP_PCL_${module}_LIBRARY})
  if(NOT CMAP_PCL_INCLUDE_DIR OR NOT CMAP_PCL_${module}_LIBRARY)
    set(CMAP_WITH_PCL OFF)
  endif()
endforeach()

# The simulator: optional. Embree casts its rays; it writes photographs.
find_package(embree 3 QUIET)
set(CMAP_WITH_SIM OFF)
if(embree_FOUND AND CMAP_WITH_IMAGES)
  set(CMAP_WITH_SIM ON)
endif()

# Pose graphs: optional.
find_package(Ceres 2.1 QUIET)
set(CMAP_WITH_CERES OFF)
if(Ceres_FOUND)
  set(CMAP_WITH_CERES ON)
endif()

function(cmap_print_summary)
  message(STATUS "cmap ${PROJECT_VERSION}, ${CMAKE_BUILD_TYPE}")
  message(STATUS "  feature      state  to change it")
  message(STATUS "  figures      ${CMAP_WITH_RENDER}     apt-get install libvtk9-dev libopencv-imgproc-dev fonts-dejavu-core")
  message(STATUS "  photographs  ${CMAP_WITH_IMAGES}     apt-get install libopencv-imgcodecs-dev")
  message(STATUS "  OpenGL       ${CMAP_WITH_GL}     apt-get install libvtk9-dev libegl-dev libgl-dev libx11-dev")
  message(STATUS "  global align ${CMAP_WITH_PCL}     apt-get install libpcl-dev")
  message(STATUS "  simulator    ${CMAP_WITH_SIM}     apt-get install libembree-dev libopencv-imgcodecs-dev (Embree 3)")
  message(STATUS "  pose graphs  ${CMAP_WITH_CERES}     apt-get install libceres-dev (2.1 or later)")
  message(STATUS "  tests        ${CMAP_BUILD_TESTS}     -DCMAP_BUILD_TESTS=ON|OFF (libgtest-dev libgmock-dev)")
  message(STATUS "  benchmarks   ${CMAP_BUILD_BENCHMARKS}    -DCMAP_BUILD_BENCHMARKS=ON|OFF (libbenchmark-dev; peers: libnanoflann-dev libpcl-dev libopen3d-dev)")
  message(STATUS "  fuzzers      ${CMAP_BUILD_FUZZERS}    -DCMAP_BUILD_FUZZERS=ON|OFF (clang)")
  message(STATUS "  report page  ${CMAP_BUILD_WEB}    -DCMAP_BUILD_WEB=ON|OFF (npm; OFF takes the page as committed)")
endfunction()

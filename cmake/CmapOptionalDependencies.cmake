# What figures, photographs, OpenGL, the simulator, pose graphs and recordings need; sets CMAP_WITH_* where all of it is
# there.

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
endif()
if(CMAP_WITH_RENDER AND TARGET VTK::RenderingOpenGL2 AND TARGET VTK::RenderingUI AND TARGET VTK::InteractionStyle AND TARGET VTK::glew
   AND TARGET OpenGL::EGL AND TARGET OpenGL::GLX AND TARGET X11::X11)
  set(CMAP_WITH_GL ON)
endif()

# Photographs of a capture: optional.
find_library(CMAP_OPENCV_IMGCODECS_LIBRARY opencv_imgcodecs)
if(CMAP_OPENCV_INCLUDE_DIR AND CMAP_OPENCV_CORE_LIBRARY AND CMAP_OPENCV_IMGPROC_LIBRARY AND CMAP_OPENCV_IMGCODECS_LIBRARY)
  set(CMAP_WITH_IMAGES ON)
endif()

# The simulator: optional. Embree casts its rays; it writes photographs.
find_package(embree 3 QUIET)
if(embree_FOUND AND CMAP_WITH_IMAGES)
  set(CMAP_WITH_SIM ON)
endif()

# Pose graphs: optional.
find_package(Ceres 2.1 QUIET)
if(Ceres_FOUND)
  set(CMAP_WITH_CERES ON)
endif()

# Recordings: optional are SQLite (rosbag2), zstd (within MCAP), and bags of ROS 1. Debian's pkg-config file of the last names
# packages that Debian does not have.
find_path(CMAP_SQLITE_INCLUDE_DIR sqlite3.h)
find_library(CMAP_SQLITE_LIBRARIES sqlite3)
if(CMAP_SQLITE_INCLUDE_DIR AND CMAP_SQLITE_LIBRARIES)
  set(CMAP_WITH_SQLITE ON)
endif()
find_path(CMAP_ZSTD_INCLUDE_DIR zstd.h)
find_library(CMAP_ZSTD_LIBRARIES zstd)
if(CMAP_ZSTD_INCLUDE_DIR AND CMAP_ZSTD_LIBRARIES)
  set(CMAP_WITH_ZSTD ON)
endif()
set(CMAP_WITH_ROSBAG ON)
set(CMAP_ROSBAG_INCLUDE_DIRS)
set(CMAP_ROSBAG_LIBRARIES)
foreach(header rosbag/bag.h pluginlib/class_loader.hpp class_loader/class_loader.hpp rcutils/logging_macros.h
    rcpputils/shared_library.hpp ament_index_cpp/get_package_prefix.hpp)
  get_filename_component(package ${header} DIRECTORY)
  find_path(CMAP_ROSBAG_${package}_DIR ${header} PATH_SUFFIXES ${package})
  if(CMAP_ROSBAG_${package}_DIR)
    list(APPEND CMAP_ROSBAG_INCLUDE_DIRS ${CMAP_ROSBAG_${package}_DIR})
  elseif(NOT package MATCHES "^(rcutils|rcpputils|ament_index_cpp)$")
    set(CMAP_WITH_ROSBAG OFF)
  endif()
endforeach()
list(REMOVE_DUPLICATES CMAP_ROSBAG_INCLUDE_DIRS)
list(REMOVE_ITEM CMAP_ROSBAG_INCLUDE_DIRS /usr/include)
foreach(library rosbag_storage roscpp_serialization rostime cpp_common console_bridge)
  find_library(CMAP_${library}_LIBRARY ${library})
  if(CMAP_${library}_LIBRARY)
    list(APPEND CMAP_ROSBAG_LIBRARIES ${CMAP_${library}_LIBRARY})
  else()
    set(CMAP_WITH_ROSBAG OFF)
  endif()
endforeach()

#pragma once

// Real clouds for the tests; they lie outside the repository: $CMAP_DATA_DIR, or ../shared/data beside it.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "cmap/io/point_cloud_file.hpp"
#include "cmap/io/transform_file.hpp"

namespace cmap::test {

inline std::filesystem::path data_folder() {
  if (const char* folder = std::getenv("CMAP_DATA_DIR")) return folder;
  const char* source = std::getenv("CMAP_SOURCE_DIR");  // set by CTest
  return std::filesystem::path(source ? source : ".") / "../shared/data";
}

#define SKIP_WITHOUT(path) \
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no real data: " << (path) << " is missing; set CMAP_DATA_DIR"

/// Two LiDAR scans half a meter apart with the true transform between them.
struct LidarPair {
  static std::filesystem::path folder() { return data_folder() / "small_gicp/data"; }
  PointCloud source = read_point_cloud(folder() / "source.ply").cloud;
  PointCloud target = read_point_cloud(folder() / "target.ply").cloud;
  Eigen::Matrix4d T_target_source = read_transform(folder() / "T_target_source.txt").T;
};

}  // namespace cmap::test

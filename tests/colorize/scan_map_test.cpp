#include "cmap/colorize/scan_map.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "cmap/core/error.hpp"
#include "cmap/geometry/voxel_map.hpp"
#include "cmap/io/lidar_scan_file.hpp"
#include "cmap/lio/lidar_map.hpp"
#include "io/io_testing.hpp"

namespace cmap {
namespace scan_map_test {

/// Scans of a wall, from a drive far from the world's origin.
Capture wall_capture(const testing::TempFolder& folder) {
  Capture capture;
  capture.folder = folder.path();
  std::mt19937 random(5);
  std::uniform_real_distribution<float> across(-3, 3);
  for (int i = 0; i < 5; ++i) {
    LidarScan scan;
    scan.timestamp_s = i;
    for (int k = 0; k < 2000; ++k) {
      scan.positions.push_back({4.0f, across(random), across(random)});
      scan.time_s.push_back(0.1f * static_cast<float>(k % 10) / 10.0f);
    }
    const std::filesystem::path path = folder / (std::to_string(i) + ".pcd");
    write_lidar_scan(scan, path);
    capture.scans.push_back({scan.timestamp_s, path});
  }
  for (int i = 0; i <= 60; ++i) {
    capture.lio.push_back({0.1 * i, {5e5 + 0.2 * i, 4e6 - 0.1 * i, 100}, Eigen::Quaterniond::Identity()});
  }
  return capture;
}

/// However the scans come, the means are those of the whole.
TEST(ScanMap, IsTheThinnedLidarMap) {
  const testing::TempFolder folder;
  const Capture capture = wall_capture(folder);
  const ScanMap map = map_of_scans(capture, capture.lio, {.voxel_m = 0.25});
  EXPECT_EQ(map.n_scans, 5u);
  EXPECT_EQ(map.n_points, 10'000u);
  EXPECT_EQ(map.n_placed, 10'000u);
  LidarMapOptions options;
  options.voxel_m = 0.25;
  constexpr double kAlways = std::numeric_limits<double>::infinity();
  const PointCloud expected = lidar_map(capture, -kAlways, kAlways, options).cloud;
  ASSERT_EQ(map.cloud.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_LT((map.cloud.world(i) - expected.world(i)).norm(), 1e-4) << "sums of floats there";
  }
}

TEST(ScanMap, NeedsScansAndPoses) {
  const testing::TempFolder folder;
  Capture capture = wall_capture(folder);
  Trajectory other{{100, {0, 0, 0}, Eigen::Quaterniond::Identity()}, {101, {1, 0, 0}, Eigen::Quaterniond::Identity()}};
  EXPECT_THROW(map_of_scans(capture, other, {}), InputError);
  capture.scans.clear();
  EXPECT_THROW(map_of_scans(capture, capture.lio, {}), InputError);
}

}  // namespace scan_map_test
}  // namespace cmap

#pragma once

// balm_hall: 177 handheld submaps of a hall with the poses of a LiDAR-inertial odometry. The data lie outside the
// repository: $CMAP_DATA_DIR, or ../shared/data beside it.

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "cmap/io/lidar_scan_file.hpp"
#include "cmap/io/trajectory_file.hpp"
#include "cmap/lio/keyframe.hpp"

namespace cmap::test {

inline std::filesystem::path balm_hall_folder() {
  if (const char* folder = std::getenv("CMAP_DATA_DIR")) return std::filesystem::path(folder) / "balm_hall";
  const char* source = std::getenv("CMAP_SOURCE_DIR");  // set by CTest
  return std::filesystem::path(source ? source : ".") / "../shared/data/balm_hall";
}

inline std::vector<Keyframe> balm_hall_keyframes() {
  std::vector<Keyframe> keyframes;
  for (const StampedPose& pose : read_trajectory(balm_hall_folder() / "poses.tum").poses) {
    Keyframe keyframe;
    keyframe.time_s = pose.time_s;
    keyframe.T_world_body.linear() = pose.rotation.toRotationMatrix();
    keyframe.T_world_body.translation() = pose.position;
    const auto file = balm_hall_folder() / "submaps" / fmt::format("{:06d}.pcd", keyframes.size());
    keyframe.points_body = read_lidar_scan(file, pose.time_s).positions;
    keyframes.push_back(std::move(keyframe));
  }
  return keyframes;
}

/// A line of loops_measured.csv: two submaps, and what point-to-plane ICP between the full ones found.
struct MeasuredLoop {
  std::size_t i = 0, j = 0;
  double distance_m = 0.0, correction_m = 0.0, correction_deg = 0.0, residual_m = 0.0, inlier_share = 0.0;
};

inline std::vector<MeasuredLoop> balm_hall_loops() {
  std::ifstream file(balm_hall_folder() / "loops_measured.csv");
  std::vector<MeasuredLoop> loops;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    for (char& c : line) c = c == ',' ? ' ' : c;
    std::istringstream text(line);
    MeasuredLoop loop;
    text >> loop.i >> loop.j >> loop.distance_m >> loop.correction_m >> loop.correction_deg >> loop.residual_m >>
        loop.inlier_share;
    loops.push_back(loop);
  }
  return loops;
}

}  // namespace cmap::test

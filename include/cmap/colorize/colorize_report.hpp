#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "cmap/colorize/colorize.hpp"
#include "cmap/colorize/refine_extrinsic.hpp"
#include "cmap/colorize/scan_map.hpp"

namespace cmap {

/// What a map was colored from, beside what came of it.
struct ColorizeInput {
  std::optional<ScanMap> scans;                  ///< its cloud is not looked at; none: a map that was given
  double voxel_m = 0.0;                          ///< that the map was thinned to; 0: not
  std::size_t n_chosen = 0, n_without_pose = 0;  ///< images
  Eigen::Isometry3d T_lidar_camera = Eigen::Isometry3d::Identity();
};

/// Lines for people: points, images, views of a seen point, range of gains, inconsistency.
std::string colorize_table(const Colorization& result, const ColorizeInput& input);

/// Everything, each image too. Schema "cmap.colorize/1".
nlohmann::ordered_json colorize_json(const Colorization& result, const ColorizeInput& input,
                                     const ColorizeOptions& options, const std::string& command);

/// The change in degrees and centimeters, how sure it is, and what it improves; and that it was not applied.
std::string refined_table(const RefinedExtrinsic& refined);
nlohmann::ordered_json refined_json(const RefinedExtrinsic& refined);

}  // namespace cmap

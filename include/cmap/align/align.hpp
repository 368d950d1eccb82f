#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string_view>

#include "cmap/align/alignment.hpp"
#include "cmap/core/point_cloud.hpp"

namespace cmap {

enum class AlignMethod {
  kIcp,     ///< SE(3), point to point
  kPlane,   ///< SE(3), point to plane
  kGicp,    ///< SE(3), plane to plane
  kSim3,    ///< Sim(3), the paper's regularized ICP (sim3_icp.hpp), settled by GICP with scale
  kGlobal,  ///< from no guess, SE(3) or Sim(3): global.hpp
};

/// "icp", "plane", "gicp", "sim3", "global"; throws UsageError for others, naming them.
AlignMethod align_method_from_name(std::string_view name);

struct AlignOptions {
  Eigen::Matrix4d T_initial = Eigen::Matrix4d::Identity();  ///< dst from src; not used by kGlobal
  /// Of the thinned source, in the target's units, at the finest level; without one the target's size / 400, but at
  /// least twice its points' median spacing. Finer: more accurate and slower.
  std::optional<double> voxel_m;
  /// Farther pairs are no matches at the finest level; without one 10 voxels. It must exceed what the initial transform
  /// is wrong by divided by 4 (levels begin 4 times as coarse), for kSim3 (where it is the first gate) that itself.
  std::optional<double> max_distance_m;
  bool with_scale = false;  ///< kGlobal, kIcp, kPlane, kGicp: estimate the scale too; kSim3 always does
};

/// Aligns a source map to a target map: one door to icp.hpp, sim3_icp.hpp and global.hpp. Units are meters; the clouds
/// may lie anywhere. Thread-safe; bitwise the same for any number of threads. Throws UnsupportedError where the
/// alignment cannot be determined (no overlap; a plane, line, sphere or corridor, saying which direction is free;
/// T_initial no similarity) and for kGlobal in a build without PCL, UsageError for wrong options,
/// std::invalid_argument on an empty cloud.
Alignment align(const PointCloud& source, const PointCloud& target, AlignMethod method,
                const AlignOptions& options = {});

/// The voxel that align() takes where none is given.
double default_align_voxel_m(const PointCloud& target);

/// Everything in an Alignment as JSON: units in the names, T_dst_src as rows.
nlohmann::ordered_json alignment_json(const Alignment& alignment);

}  // namespace cmap

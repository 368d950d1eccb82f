#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "cmap/align/verdict.hpp"
#include "cmap/lio/loop_options.hpp"
#include "loops/patch_agreement.hpp"

namespace cmap {

/// A submap ready to be aligned: its points in its level frame, and their surface.
struct SubmapSurface {
  SubmapSurface(PointCloud cloud, const LoopOptions& options);

  PointCloud points;
  PlaneGrid planes;
};

/// What ICP made of a pair of submaps.
struct SubmapAlignment {
  Eigen::Isometry3d T_from_to = Eigen::Isometry3d::Identity();  ///< level frames
  PatchAgreement agreement;
  double error_m = std::numeric_limits<double>::quiet_NaN();  ///< standard error of the weakest direction
  double rmse_m = std::numeric_limits<double>::quiet_NaN();
  bool is_aligned = false;
  Judgment judgment;
};

/// Aligns `to` onto `from` from each start, keeps what agrees best and judges it: unsupported where too little agrees
/// beyond chance, or ICP finds no answer; ambiguous where another start ends elsewhere and agrees nearly as well; weak
/// where a direction is less certain than largest_error_m; else determined.
SubmapAlignment align_submaps(const SubmapSurface& from, const SubmapSurface& to,
                              std::span<const Eigen::Isometry3d> starts, const LoopOptions& options);

}  // namespace cmap

#pragma once

#include <optional>

#include "cmap/align/alignment.hpp"
#include "cmap/geometry/point_cloud.hpp"

namespace cmap {

/// Registration without a starting guess.
struct GlobalOptions {
  bool with_scale = false;        ///< also an unknown scale, from 0.001 to 1000
  std::optional<double> voxel_m;  ///< of the search; without one a hundredth of the smaller map's size, or wider
  /// Of the refinement (GICP), its finest level; without one voxel_m / 8.
  std::optional<double> fine_voxel_m;
};

/// Stands both maps upright by what their surfaces face most, searches all turns about the vertical and all shifts of
/// what stands on their plans, refines the best poses by GICP, and judges them against each other
/// (Alignment::judgment). An unknown scale is tried in steps of 4 %, up to a factor of 1.9 around the one that gives
/// the maps one size. Deterministic: no random numbers. Thread-safe. Throws UnsupportedError where nothing meets, and
/// as icp() does.
Alignment global_registration(const PointCloud& source, const PointCloud& target, const GlobalOptions& options = {});

}  // namespace cmap

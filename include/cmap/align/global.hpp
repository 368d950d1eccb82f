#pragma once

#include <optional>

#include "cmap/align/alignment.hpp"
#include "cmap/geometry/point_cloud.hpp"

namespace cmap {

/// Registration without a starting guess.
struct GlobalOptions {
  bool with_scale = false;        ///< also an unknown scale, within a factor of about 1.5
  std::optional<double> voxel_m;  ///< for features; without one the target's size / 100
  /// Of the refinement (GICP), its finest level; without one voxel_m / 8, but no finer than the clouds.
  std::optional<double> fine_voxel_m;
  std::size_t most_matches = 2000;  ///< of features that take part
};

/// FPFH features (Rusu 2009) on thinned clouds, mutual nearest matches, the largest set of matches that keep each
/// other's distances (second-order compatibility as in SC2-PCR, Chen et al. 2022; with an unknown scale, distances up
/// to a common factor found by voting), the best of several hypotheses by overlap of the clouds, then GICP from coarse
/// to fine. Deterministic: no random numbers. Thread-safe after the first call. Throws UnsupportedError where cmap was
/// built without PCL, where nothing matches, and as icp() does.
Alignment global_registration(const PointCloud& source, const PointCloud& target, const GlobalOptions& options = {});

}  // namespace cmap

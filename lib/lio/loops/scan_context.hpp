#pragma once

#include <Eigen/Core>

#include "cmap/geometry/point_cloud.hpp"

namespace cmap {

/// Scan Context (Kim and Kim, IROS 2018), the descriptor that most peers use, to compare with: the greatest height
/// above ground in rings and sectors about the place. It knows turns, in steps of a sector, but no shift. Not used by
/// close_loops().
struct ScanContext {
  static constexpr int kRings = 20, kSectors = 60;
  Eigen::MatrixXf heights;   ///< row a ring, column a sector; 0 where there is no point
  Eigen::VectorXf ring_key;  ///< mean of each ring: does not change with turns
};

/// Of points in a level frame whose ground is at ground_m; heights below it count as 0.
ScanContext scan_context(const PointCloud& points, double ground_m, double radius_m = 80.0);

struct ScanContextMatch {
  double distance =
      1.0;  ///< mean over the sectors that both have of 1 - cosine of their columns, 0 to 1, least of all turns
  double yaw_rad = 0.0;  ///< of the source to lie on the target, [0, 2 pi)
};
/// All turns are tried. Without a common sector the distance is 1.
ScanContextMatch best_turn(const ScanContext& source, const ScanContext& target);

}  // namespace cmap

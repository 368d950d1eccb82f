#pragma once

#include <optional>

#include "cmap/align/alignment.hpp"
#include "cmap/core/execution.hpp"
#include "cmap/geometry/point_cloud.hpp"

namespace cmap {

/// The evaluation of the Tanks and Temples benchmark (Knapitsch et al. 2017), as its public toolbox does it
/// (github.com/isl-org/TanksAndTemples, python_toolbox/evaluation), for a scene's distance tau.
struct TanksAndTemplesOptions {
  double tau_m = 0.0;                 ///< the scene's threshold; required
  std::optional<Box3d> crop;          ///< in place of the toolbox's polygon, in the target's frame
  bool refine = true;                 ///< the three stages; false: the initial transform is taken as it is
  std::size_t most_points = 4000000;  ///< of the third stage; larger clouds keep every k-th point
};

struct TanksAndTemplesResult {
  double precision = 0.0;  ///< share of the source's points nearer than tau to the target; 0 without points
  double recall = 0.0;     ///< share of the target's points nearer than tau to the source
  double f_score = 0.0;    ///< 2 P R / (P + R), 0 where both are 0
  std::size_t n_source = 0, n_target = 0;  ///< points that were compared, thinned to tau / 2
  Alignment alignment;
};

/// Refines T_initial by point-to-point ICP with a free scale in three stages: both clouds (the source moved first)
/// cropped and thinned to tau with matches up to 80 tau; to tau / 2 and 20 tau; every k-th point and 2 tau. Each ends
/// when the share of matched points changes by less than 1e-6, or after 30 iterations: the toolbox writes 20, but hands
/// them to Open3D in the place of another parameter. Then precision, recall and F at tau (nearer, not equal), both
/// thinned to tau / 2. Thinning here is on a lattice through the world's origin, Open3D's through each cloud's corner:
/// scores agree to the extent that they do not depend on that. Deterministic, thread-safe. Throws UsageError unless tau
/// > 0, UnsupportedError where a stage has nothing to match, std::invalid_argument on empty clouds.
TanksAndTemplesResult tanks_and_temples(const PointCloud& source, const PointCloud& target,
                                        const Eigen::Matrix4d& T_initial, const TanksAndTemplesOptions& options,
                                        const Execution& execution = {});

}  // namespace cmap

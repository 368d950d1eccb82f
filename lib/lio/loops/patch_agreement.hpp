#pragma once

#include <Eigen/Geometry>

#include "loops/plane_grid.hpp"

namespace cmap {

/// How the surfaces of two submaps agree at a pose.
struct PatchAgreement {
  double share = 0.0;   ///< of the patches that both could show, those that agree; upright and level ones count alike
  double score = 0.0;   ///< the same beyond chance: 0 as anywhere nearby, 1 at most
  double places = 0.0;  ///< patches that agree beyond chance
  double rmse_m = 0.0;  ///< of the distances between agreeing patches, along the normal; NaN without any
};

/// Patches of the source, moved by T_target_source (level frames), against those of the target: they agree where they
/// are within `tolerance_m` of each other along both normals, which differ by less than 25 degrees. Chance is what
/// agrees on average after shifts by 4 and 9 patches across the vertical, in six directions: on streets, everything
/// agrees with the ground.
PatchAgreement agreement_of(const PlaneGrid& source, const PlaneGrid& target, const Eigen::Isometry3d& T_target_source,
                            double tolerance_m);

}  // namespace cmap

#include "loops/loop_fields.hpp"

namespace cmap {

OptionFields option_fields(LoopOptions& o) {
  constexpr NumberRange similarity{.low = -1.0, .high = 1.0};
  return {field("submap_m", o.submap_m, kPositive),
          field("submap_spacing_m", o.submap_spacing_m, kPositive),
          field("voxel_m", o.voxel_m, kPositive),
          field("revisit_m", o.revisit_m, kPositive),
          field("min_path_m", o.min_path_m, kPositive),
          field("drift_share", o.drift_share, kFraction),
          field("drift_m", o.drift_m, kNotNegative),
          field("max_drift_m", o.max_drift_m, kNotNegative),
          field("drift_deg", o.drift_deg, kNotNegative),
          field("drift_deg_per_km", o.drift_deg_per_km, kNotNegative),
          field("max_drift_deg", o.max_drift_deg, kNotNegative),
          field("pose_candidates", o.pose_candidates, kNotNegative),
          field("descriptor_candidates", o.descriptor_candidates, kNotNegative),
          field("least_similarity", o.least_similarity, similarity),
          field("reach_m", o.reach_m, kPositive),
          field("rounds", o.rounds, kPositive),
          field("least_score", o.least_score, kFraction),
          field("least_places", o.least_places, kNotNegative),
          field("largest_error_m", o.largest_error_m, kPositive),
          field("rival_score_share", o.rival_score_share, kFraction),
          field("odometry_sigma_m_per_sqrt_m", o.odometry_sigma_m_per_sqrt_m, kPositive),
          field("odometry_sigma_deg_per_sqrt_m", o.odometry_sigma_deg_per_sqrt_m, kPositive),
          field("gravity_sigma_deg", o.gravity_sigma_deg, kNotNegative),
          field("loop_sigma_m", o.loop_sigma_m, kPositive),
          field("loop_sigma_deg", o.loop_sigma_deg, kPositive),
          field("cauchy_width", o.cauchy_width, kPositive),
          field("largest_residual", o.largest_residual, kPositive)};
}

}  // namespace cmap

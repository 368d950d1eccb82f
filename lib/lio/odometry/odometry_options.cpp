#include "cmap/lio/odometry_options.hpp"

namespace cmap {

OptionFields option_fields(OdometryOptions& o) {
  return {
      field("min_range_m", o.min_range_m, kNotNegative),
      field("max_range_m", o.max_range_m, kPositive),
      field("range_noise_m", o.range_noise_m, kPositive),
      field("beam_noise_deg", o.beam_noise_deg, kNotNegative),
      field("model_noise_m", o.model_noise_m, kPositive),
      field("voxel_m", o.voxel_m, kPositive),
      field("levels", o.levels, NumberRange{1, 6}),
      field("plane_thickness_m", o.plane_thickness_m, kPositive),
      field("cell_points", o.cell_points, NumberRange{6, 1e6}),
      field("forget_after_m", o.forget_after_m, kPositive),
      field("scan_voxel_m", o.scan_voxel_m, kPositive),
      field("scan_points", o.scan_points, NumberRange{100, 1e6}),
      field("insert_voxel_m", o.insert_voxel_m, kPositive),
      field("iterations", o.iterations, NumberRange{1, 100}),
      field("gate", o.gate, kPositive),
      field("gyro_noise", o.gyro_noise, kPositive),
      field("force_noise", o.force_noise, kPositive),
      field("gyro_bias_walk", o.gyro_bias_walk, kNotNegative),
      field("force_bias_walk", o.force_bias_walk, kNotNegative),
      field("free_rate", o.free_rate, kPositive),
      field("free_turn", o.free_turn, kPositive),
      field("free_force", o.free_force, kPositive),
      field("max_imu_gap_s", o.max_imu_gap_s, kPositive),
      field("use_imu", o.use_imu),
  };
}

}  // namespace cmap

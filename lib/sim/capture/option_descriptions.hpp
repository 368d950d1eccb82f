#pragma once

#include "cmap/core/options.hpp"
#include "cmap/sim/imu.hpp"
#include "cmap/sim/lidar.hpp"
#include "cmap/sim/path.hpp"
#include "cmap/sim/predictions.hpp"

/// Names and ranges of all options of the sensors.
namespace cmap {

inline OptionFields option_fields(PathOptions& o) {
  return {
      field("rest_s", o.rest_s, kNotNegative),
      field("ramp_s", o.ramp_s, kPositive),
      field("speed_mps", o.speed_mps, kPositive),
      field("hold_s", o.hold_s, kNotNegative),
      field("corner_m", o.corner_m, kPositive),
      field("heading_offset_deg", o.heading_offset_deg),
      field("turn_with_route", o.turn_with_route),
      field("sway_position_m", o.sway_position_m, kNotNegative),
      field("sway_roll_deg", o.sway_roll_deg, kNotNegative),
      field("sway_pitch_deg", o.sway_pitch_deg, kNotNegative),
      field("sway_yaw_deg", o.sway_yaw_deg, kNotNegative),
      field("sway_frequency_hz", o.sway_frequency_hz, kPositive),
      field("knot_spacing_s", o.knot_spacing_s, kPositive),
      field("start_time_s", o.start_time_s, kNotNegative),
  };
}

inline OptionFields option_fields(ImuOptions& o) {
  return {
      field("rate_hz", o.rate_hz, kPositive),
      field("gyro_noise_density_radps_per_sqrt_hz", o.gyro_noise_density_radps_per_sqrt_hz, kNotNegative),
      field("accelerometer_noise_density_mps2_per_sqrt_hz", o.accelerometer_noise_density_mps2_per_sqrt_hz,
            kNotNegative),
      field("gyro_bias_walk_radps2_per_sqrt_hz", o.gyro_bias_walk_radps2_per_sqrt_hz, kNotNegative),
      field("accelerometer_bias_walk_mps3_per_sqrt_hz", o.accelerometer_bias_walk_mps3_per_sqrt_hz, kNotNegative),
      field("gyro_bias_radps", o.gyro_bias_radps, kNotNegative),
      field("accelerometer_bias_mps2", o.accelerometer_bias_mps2, kNotNegative),
      field("gravity_mps2", o.gravity_mps2, kNotNegative),
      field("accelerometer_lever_arm_m", o.accelerometer_lever_arm_m),
  };
}

inline const EnumNames<LidarPattern> kLidarPatternNames{
    {LidarPattern::kSpinning, "spinning"}, {LidarPattern::kAviaRosette, "avia"}, {LidarPattern::kMid360, "mid360"}};

inline OptionFields option_fields(LidarOptions& o) {
  return {
      field("pattern", o.pattern, kLidarPatternNames),
      field("scan_rate_hz", o.scan_rate_hz, kPositive),
      field("elevations_deg", o.elevations_deg, NumberRange{-90.0, 90.0}),
      field("azimuth_steps", o.azimuth_steps, NumberRange{1, 1e6}),
      field("start_azimuth_deg", o.start_azimuth_deg),
      field("points_per_s", o.points_per_s, NumberRange{1, 1e8}),
      field("range_noise_m", o.range_noise_m, kNotNegative),
      field("angular_noise_deg", o.angular_noise_deg, kNotNegative),
      field("min_range_m", o.min_range_m, kNotNegative),
      field("max_range_m", o.max_range_m, kPositive),
      field("half_detection_range_m", o.half_detection_range_m, kPositive),
      field("detection_steepness", o.detection_steepness, kPositive),
      field("lost_fraction", o.lost_fraction, kFraction),
      field("lossless", o.lossless),
  };
}

inline OptionFields option_fields(PredictionOptions& o) {
  return {
      field("session_length", o.session_length, NumberRange{1, 1e6}),
      field("session_overlap", o.session_overlap, NumberRange{0, 1e6}),
      field("image_stride", o.image_stride, NumberRange{1, 1e6}),
      field("width_px", o.width_px, NumberRange{14, 1e4}),
      field("unit_m", o.unit_m, kPositive),
      field("unit_factor", o.unit_factor, NumberRange{1.0, 1e6}),
      field("depth_noise_fraction", o.depth_noise_fraction, kNotNegative),
      field("depth_bias_fraction", o.depth_bias_fraction, kNotNegative),
      field("depth_bias_range_m", o.depth_bias_range_m, kPositive),
      field("depth_bias_size_px", o.depth_bias_size_px, kPositive),
      field("edge_fraction", o.edge_fraction, kPositive),
      field("floater_fraction", o.floater_fraction, kFraction),
      field("max_depth_m", o.max_depth_m, kPositive),
      field("sky_depth_m", o.sky_depth_m, kPositive),
      field("pose_noise_m", o.pose_noise_m, kNotNegative),
      field("pose_noise_deg", o.pose_noise_deg, kNotNegative),
      field("pose_scale_fraction", o.pose_scale_fraction, kNotNegative),
      field("pose_drift_fraction", o.pose_drift_fraction, kNotNegative),
      field("pose_drift_deg_per_frame", o.pose_drift_deg_per_frame, kNotNegative),
      field("focal_noise_fraction", o.focal_noise_fraction, kNotNegative),
      field("outlier_sessions", o.outlier_sessions, NumberRange{0, 1e6}),
      field("outlier_fraction", o.outlier_fraction, kFraction),
      field("outlier_stretch", o.outlier_stretch, kPositive),
      field("confidence_peak", o.confidence_peak, NumberRange{.low = 1.0}),
      field("confidence_half_error_m", o.confidence_half_error_m, kPositive),
      field("confidence_insight", o.confidence_insight, kFraction),
      field("confidence_noise", o.confidence_noise, kNotNegative),
      field("world_points", o.world_points),
  };
}

/// Throws UsageError "where: field: value and rule" for the first value out of its range.
template <class Options>
void check_fields(Options options, const char* where) {
  check_options(option_fields(options), where);
}

}  // namespace cmap

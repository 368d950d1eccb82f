#pragma once

#include <string>

#include "cmap/core/option_fields.hpp"
#include "cmap/sim/imu.hpp"
#include "cmap/sim/lidar.hpp"
#include "cmap/sim/path.hpp"
#include "cmap/sim/predictions.hpp"

/// Names and ranges of all options of the sensors: `Fields` is a visitor of option_fields.hpp, `Options` may be const.
namespace cmap {

template <class Fields>
void describe(Fields& f, FieldsOf<Fields, PathOptions>& o) {
  f.field("rest_s", o.rest_s, kNotNegative);
  f.field("ramp_s", o.ramp_s, kPositive);
  f.field("speed_mps", o.speed_mps, kPositive);
  f.field("hold_s", o.hold_s, kNotNegative);
  f.field("corner_m", o.corner_m, kPositive);
  f.field("heading_offset_deg", o.heading_offset_deg);
  f.field("turn_with_route", o.turn_with_route);
  f.field("sway_position_m", o.sway_position_m, kNotNegative);
  f.field("sway_roll_deg", o.sway_roll_deg, kNotNegative);
  f.field("sway_pitch_deg", o.sway_pitch_deg, kNotNegative);
  f.field("sway_yaw_deg", o.sway_yaw_deg, kNotNegative);
  f.field("sway_frequency_hz", o.sway_frequency_hz, kPositive);
  f.field("knot_spacing_s", o.knot_spacing_s, kPositive);
  f.field("start_time_s", o.start_time_s, kNotNegative);
}

template <class Fields>
void describe(Fields& f, FieldsOf<Fields, ImuOptions>& o) {
  f.field("rate_hz", o.rate_hz, kPositive);
  f.field("gyro_noise_density_radps_per_sqrt_hz", o.gyro_noise_density_radps_per_sqrt_hz, kNotNegative);
  f.field("accelerometer_noise_density_mps2_per_sqrt_hz", o.accelerometer_noise_density_mps2_per_sqrt_hz, kNotNegative);
  f.field("gyro_bias_walk_radps2_per_sqrt_hz", o.gyro_bias_walk_radps2_per_sqrt_hz, kNotNegative);
  f.field("accelerometer_bias_walk_mps3_per_sqrt_hz", o.accelerometer_bias_walk_mps3_per_sqrt_hz, kNotNegative);
  f.field("gyro_bias_radps", o.gyro_bias_radps, kNotNegative);
  f.field("accelerometer_bias_mps2", o.accelerometer_bias_mps2, kNotNegative);
  f.field("gravity_mps2", o.gravity_mps2, kNotNegative);
  f.field("accelerometer_lever_arm_m", o.accelerometer_lever_arm_m);
}

inline const EnumNames<LidarPattern> kLidarPatternNames{
    {LidarPattern::kSpinning, "spinning"}, {LidarPattern::kAviaRosette, "avia"}, {LidarPattern::kMid360, "mid360"}};

template <class Fields>
void describe(Fields& f, FieldsOf<Fields, LidarOptions>& o) {
  f.field("pattern", o.pattern, kLidarPatternNames);
  f.field("scan_rate_hz", o.scan_rate_hz, kPositive);
  f.field("elevations_deg", o.elevations_deg, NumberRange{-90.0, 90.0});
  f.field("azimuth_steps", o.azimuth_steps, NumberRange{1, 1e6});
  f.field("start_azimuth_deg", o.start_azimuth_deg);
  f.field("points_per_s", o.points_per_s, NumberRange{1, 1e8});
  f.field("range_noise_m", o.range_noise_m, kNotNegative);
  f.field("angular_noise_deg", o.angular_noise_deg, kNotNegative);
  f.field("min_range_m", o.min_range_m, kNotNegative);
  f.field("max_range_m", o.max_range_m, kPositive);
  f.field("half_detection_range_m", o.half_detection_range_m, kPositive);
  f.field("detection_steepness", o.detection_steepness, kPositive);
  f.field("lost_fraction", o.lost_fraction, kFraction);
  f.field("lossless", o.lossless);
}

template <class Fields>
void describe(Fields& f, FieldsOf<Fields, PredictionOptions>& o) {
  f.field("session_length", o.session_length, NumberRange{1, 1e6});
  f.field("session_overlap", o.session_overlap, NumberRange{0, 1e6});
  f.field("image_stride", o.image_stride, NumberRange{1, 1e6});
  f.field("width_px", o.width_px, NumberRange{14, 1e4});
  f.field("unit_m", o.unit_m, kPositive);
  f.field("unit_factor", o.unit_factor, NumberRange{1.0, 1e6});
  f.field("depth_noise_fraction", o.depth_noise_fraction, kNotNegative);
  f.field("depth_bias_fraction", o.depth_bias_fraction, kNotNegative);
  f.field("depth_bias_range_m", o.depth_bias_range_m, kPositive);
  f.field("depth_bias_size_px", o.depth_bias_size_px, kPositive);
  f.field("edge_fraction", o.edge_fraction, kPositive);
  f.field("floater_fraction", o.floater_fraction, kFraction);
  f.field("max_depth_m", o.max_depth_m, kPositive);
  f.field("sky_depth_m", o.sky_depth_m, kPositive);
  f.field("pose_noise_m", o.pose_noise_m, kNotNegative);
  f.field("pose_noise_deg", o.pose_noise_deg, kNotNegative);
  f.field("pose_scale_fraction", o.pose_scale_fraction, kNotNegative);
  f.field("pose_drift_fraction", o.pose_drift_fraction, kNotNegative);
  f.field("pose_drift_deg_per_frame", o.pose_drift_deg_per_frame, kNotNegative);
  f.field("focal_noise_fraction", o.focal_noise_fraction, kNotNegative);
  f.field("outlier_sessions", o.outlier_sessions, NumberRange{0, 1e6});
  f.field("outlier_fraction", o.outlier_fraction, kFraction);
  f.field("outlier_stretch", o.outlier_stretch, kPositive);
  f.field("confidence_peak", o.confidence_peak, NumberRange{.low = 1.0});
  f.field("confidence_half_error_m", o.confidence_half_error_m, kPositive);
  f.field("confidence_insight", o.confidence_insight, kFraction);
  f.field("confidence_noise", o.confidence_noise, kNotNegative);
  f.field("world_points", o.world_points);
}

/// Throws UsageError "where: field: value and rule" for the first value out of its range.
template <class Options>
void check_fields(const Options& options, const char* where) {
  FieldChecker checker(where);
  describe(checker, options);
}

template <class Options>
void read_fields(Options& options, const nlohmann::ordered_json& object, const std::string& where) {
  FieldReader reader(object, where);
  describe(reader, options);
  reader.finish();
}

template <class Options>
nlohmann::ordered_json written_fields(const Options& options) {
  FieldWriter writer;
  describe(writer, options);
  return writer.finish();
}

}  // namespace cmap

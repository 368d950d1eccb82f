#pragma once

#include "capture/option_descriptions.hpp"
#include "cmap/sim/capture_options.hpp"

/// Names and ranges of the options that only a whole capture has, as in option_descriptions.hpp.
namespace cmap {

inline const EnumNames<SceneKind> kSceneKindNames{{SceneKind::kTown, "town"},
                                                  {SceneKind::kIndoor, "indoor"},
                                                  {SceneKind::kAerial, "aerial"},
                                                  {SceneKind::kMesh, "mesh"}};
inline const EnumNames<RouteKind> kRouteKindNames{{RouteKind::kScene, "scene"},
                                                  {RouteKind::kStraight, "straight"},
                                                  {RouteKind::kBlock, "block"},
                                                  {RouteKind::kSurvey, "survey"},
                                                  {RouteKind::kHover, "hover"}};
inline const EnumNames<CameraProjection> kProjectionNames{{CameraProjection::kPinhole, "pinhole"},
                                                          {CameraProjection::kFisheye, "fisheye"}};

/// Also the extensions of their files.
inline const EnumNames<PictureFormat> kPictureFormatNames{{PictureFormat::kJpg, "jpg"}, {PictureFormat::kPng, "png"}};

// The makers of the scenes check the ranges of theirs.
inline OptionFields option_fields(TownOptions& o) {
  return {
      field("blocks_x", o.blocks_x, kAnyNumber), field("blocks_y", o.blocks_y, kAnyNumber),
      field("block_x_m", o.block_x_m),           field("block_y_m", o.block_y_m),
      field("street_width_m", o.street_width_m), field("undulation_m", o.undulation_m),
      field("trees_per_100m", o.trees_per_100m), field("cars_per_100m", o.cars_per_100m),
  };
}

inline OptionFields option_fields(IndoorOptions& o) {
  return {
      field("length_m", o.length_m),   field("width_m", o.width_m),     field("corridor_width_m", o.corridor_width_m),
      field("ceiling_m", o.ceiling_m), field("furniture", o.furniture),
  };
}

inline OptionFields option_fields(AerialOptions& o) {
  return {
      field("length_m", o.length_m),
      field("width_m", o.width_m),
      field("relief_m", o.relief_m),
      field("buildings", o.buildings, kAnyNumber),
      field("trees", o.trees, kAnyNumber),
      field("survey_altitude_m", o.survey_altitude_m),
      field("survey_spacing_m", o.survey_spacing_m),
  };
}

inline OptionField kind_field(SceneChoice& o) { return field("kind", o.kind, kSceneKindNames); }

/// Those of the kind that it is: others are unknown.
inline OptionFields option_fields(SceneChoice& o) {
  const OptionFields all{kind_field(o), field("seed", o.seed, kNotNegative)};
  if (o.kind == SceneKind::kTown) return joined({all, option_fields(o.town)});
  if (o.kind == SceneKind::kIndoor) return joined({all, option_fields(o.indoor)});
  if (o.kind == SceneKind::kAerial) return joined({all, option_fields(o.aerial)});
  return joined({all, {field("mesh", o.mesh)}});
}

inline OptionFields option_fields(RouteChoice& o) {
  return {
      field("kind", o.kind, kRouteKindNames),
      field("name", o.name),
      field("height_m", o.height_m),
      field("begin_m", o.begin_m, kNotNegative),
      field("length_m", o.length_m, kNotNegative),
      field("start_m", o.start_m),
      field("heading_deg", o.heading_deg),
      field("min_m", o.min_m),
      field("max_m", o.max_m),
      field("overlap_m", o.overlap_m, kNotNegative),
      field("line_distance_m", o.line_distance_m, kPositive),
  };
}

inline OptionFields option_fields(MountOptions& o) {
  return {
      field("lidar_translation_m", o.lidar_translation_m),
      field("lidar_roll_pitch_yaw_deg", o.lidar_roll_pitch_yaw_deg),
      field("camera_translation_m", o.camera_translation_m),
      field("camera_roll_pitch_yaw_deg", o.camera_roll_pitch_yaw_deg),
  };
}

inline OptionFields option_fields(CameraOptions& o) {
  return {
      field("projection", o.projection, kProjectionNames),
      field("width_px", o.width_px, NumberRange{1, 20000}),
      field("height_px", o.height_px, NumberRange{1, 20000}),
      field("focal_px", o.focal_px, kPositive),
      field("center_offset_px", o.center_offset_px),
      field("distortion", o.distortion, kAnyNumber),
      field("rate_hz", o.rate_hz, kPositive),
      field("phase_s", o.phase_s, kNotNegative),
      field("begin_s", o.begin_s, kNotNegative),
      field("supersampling", o.supersampling, NumberRange{1, 8}),
      field("vignetting", o.vignetting, kFraction),
      field("exposure_noise", o.exposure_noise, kNotNegative),
      field("pixel_noise_u8", o.pixel_noise_u8, kNotNegative),
      field("format", o.format, kPictureFormatNames),
  };
}

inline OptionFields option_fields(StatedOptions& o) {
  return {
      field("camera_rotation_error_deg", o.camera_rotation_error_deg),
      field("camera_translation_error_m", o.camera_translation_error_m),
      field("image_time_error_s", o.image_time_error_s),
      field("lio", o.lio),
      field("lio_drift_m_per_sqrt_m", o.lio_drift_m_per_sqrt_m, kNotNegative),
      field("lio_drift_deg_per_sqrt_m", o.lio_drift_deg_per_sqrt_m, kNotNegative),
  };
}

inline OptionFields option_fields(TruthOptions& o) {
  return {
      field("map_points_per_m2", o.map_points_per_m2, kPositive),
      field("map_max_distance_m", o.map_max_distance_m, kPositive),
      field("trajectory_rate_hz", o.trajectory_rate_hz, kPositive),
  };
}

/// Those of no section.
inline OptionFields option_fields(CaptureOptions& o) {
  return {field("seed", o.seed, kNotNegative), field("max_duration_s", o.max_duration_s, kNotNegative)};
}

/// Calls section(name, options of it) for every section.
template <class Section>
void for_each_section(CaptureOptions& o, Section&& section) {
  section("scene", o.scene);
  section("route", o.route);
  section("path", o.path);
  section("imu", o.imu);
  section("lidar", o.lidar);
  section("mount", o.mount);
  section("camera", o.camera);
  section("predictions", o.predictions);
  section("stated", o.stated);
  section("truth", o.truth);
}

}  // namespace cmap

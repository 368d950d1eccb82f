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

// The makers of the scenes check the ranges of theirs.
template <class Fields, class Town>
void describe_town(Fields& f, Town& o) {
  f.field("blocks_x", o.blocks_x, kAnyNumber);
  f.field("blocks_y", o.blocks_y, kAnyNumber);
  f.field("block_x_m", o.block_x_m);
  f.field("block_y_m", o.block_y_m);
  f.field("street_width_m", o.street_width_m);
  f.field("undulation_m", o.undulation_m);
  f.field("trees_per_100m", o.trees_per_100m);
  f.field("cars_per_100m", o.cars_per_100m);
}

template <class Fields, class Indoor>
void describe_indoor(Fields& f, Indoor& o) {
  f.field("length_m", o.length_m);
  f.field("width_m", o.width_m);
  f.field("corridor_width_m", o.corridor_width_m);
  f.field("ceiling_m", o.ceiling_m);
  f.field("furniture", o.furniture);
}

template <class Fields, class Aerial>
void describe_aerial(Fields& f, Aerial& o) {
  f.field("length_m", o.length_m);
  f.field("width_m", o.width_m);
  f.field("relief_m", o.relief_m);
  f.field("buildings", o.buildings, kAnyNumber);
  f.field("trees", o.trees, kAnyNumber);
  f.field("survey_altitude_m", o.survey_altitude_m);
  f.field("survey_spacing_m", o.survey_spacing_m);
}

template <class Fields>
void describe(Fields& f, FieldsOf<Fields, SceneChoice>& o) {
  f.field("kind", o.kind, kSceneKindNames);
  f.field("seed", o.seed, kNotNegative);
  // The kind is known by now: keys of other kinds are unknown.
  if (o.kind == SceneKind::kTown) describe_town(f, o.town);
  if (o.kind == SceneKind::kIndoor) describe_indoor(f, o.indoor);
  if (o.kind == SceneKind::kAerial) describe_aerial(f, o.aerial);
  if (o.kind == SceneKind::kMesh) f.field("mesh", o.mesh);
}

template <class Fields>
void describe(Fields& f, FieldsOf<Fields, RouteChoice>& o) {
  f.field("kind", o.kind, kRouteKindNames);
  f.field("name", o.name);
  f.field("height_m", o.height_m);
  f.field("begin_m", o.begin_m, kNotNegative);
  f.field("length_m", o.length_m, kNotNegative);
  f.field("start_m", o.start_m);
  f.field("heading_deg", o.heading_deg);
  f.field("min_m", o.min_m);
  f.field("max_m", o.max_m);
  f.field("overlap_m", o.overlap_m, kNotNegative);
  f.field("line_distance_m", o.line_distance_m, kPositive);
}

template <class Fields>
void describe(Fields& f, FieldsOf<Fields, MountOptions>& o) {
  f.field("lidar_translation_m", o.lidar_translation_m);
  f.field("lidar_roll_pitch_yaw_deg", o.lidar_roll_pitch_yaw_deg);
  f.field("camera_translation_m", o.camera_translation_m);
  f.field("camera_roll_pitch_yaw_deg", o.camera_roll_pitch_yaw_deg);
}

template <class Fields>
void describe(Fields& f, FieldsOf<Fields, CameraOptions>& o) {
  f.field("projection", o.projection, kProjectionNames);
  f.field("width_px", o.width_px, NumberRange{1, 20000});
  f.field("height_px", o.height_px, NumberRange{1, 20000});
  f.field("focal_px", o.focal_px, kPositive);
  f.field("center_offset_px", o.center_offset_px);
  f.field("distortion", o.distortion, kAnyNumber);
  f.field("rate_hz", o.rate_hz, kPositive);
  f.field("phase_s", o.phase_s, kNotNegative);
  f.field("begin_s", o.begin_s, kNotNegative);
  f.field("supersampling", o.supersampling, NumberRange{1, 8});
  f.field("vignetting", o.vignetting, kFraction);
  f.field("exposure_noise", o.exposure_noise, kNotNegative);
  f.field("pixel_noise_u8", o.pixel_noise_u8, kNotNegative);
  f.field("format", o.format);
}

template <class Fields>
void describe(Fields& f, FieldsOf<Fields, StatedOptions>& o) {
  f.field("camera_rotation_error_deg", o.camera_rotation_error_deg);
  f.field("camera_translation_error_m", o.camera_translation_error_m);
  f.field("image_time_error_s", o.image_time_error_s);
  f.field("lio", o.lio);
  f.field("lio_drift_m_per_sqrt_m", o.lio_drift_m_per_sqrt_m, kNotNegative);
  f.field("lio_drift_deg_per_sqrt_m", o.lio_drift_deg_per_sqrt_m, kNotNegative);
}

template <class Fields>
void describe(Fields& f, FieldsOf<Fields, TruthOptions>& o) {
  f.field("map_points_per_m2", o.map_points_per_m2, kPositive);
  f.field("map_max_distance_m", o.map_max_distance_m, kPositive);
  f.field("trajectory_rate_hz", o.trajectory_rate_hz, kPositive);
}

/// Calls section(name, options of it) for every section.
template <class Options, class Section>
void for_each_section(Options& o, Section&& section) {
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

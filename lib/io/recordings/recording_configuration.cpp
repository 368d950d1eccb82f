#include <fmt/format.h>

#include "bytes/input_json.hpp"
#include "captures/capture_json.hpp"
#include "cmap/core/error.hpp"
#include "cmap/io/recording.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

std::string text_of(const Json& json, std::string_view name) {
  if (!json.is_string() || json.get_ref<const std::string&>().empty()) {
    throw UsageError(fmt::format("{} is {}; the name of a topic expected", name, json.dump()));
  }
  return json.get<std::string>();
}

/// {"lidar": "/velodyne_points", ...}
void read_names(const Json& json, const char* where, RecordingOptions& options, std::string RecordingSource::*member) {
  check_keys(json, where, {}, {"lidar", "imu", "image", "odometry"});
  for (const auto& [role, name] : recording_role_names()) {
    if (json.contains(name)) options.source(role).*member = text_of(json[name], fmt::format("{}.{}", where, name));
  }
}

PointTimeUnit unit_of(const Json& json) {
  for (const auto& [unit, name] : point_time_unit_names()) {
    if (json == name) return unit;
  }
  throw UsageError(fmt::format("recording.point_time_unit is {}; one of {} expected", json.dump(),
                               fmt::join(words_of(point_time_unit_names()), ", ")));
}

void read_recording(const Json& json, RecordingOptions& options) {
  check_keys(json, "recording", {}, {"topics", "time_reference", "point_time_unit"});
  if (json.contains("topics")) read_names(json["topics"], "recording.topics", options, &RecordingSource::topic);
  for (RecordingSource& source : options.sources) {
    if (!source.topic.empty()) source.want = Want::kYes;
  }
  if (json.contains("time_reference")) {
    read_names(json["time_reference"], "recording.time_reference", options, &RecordingSource::time_reference);
  }
  if (json.contains("point_time_unit")) options.point_time_unit = unit_of(json["point_time_unit"]);
}

}  // namespace

RecordingConfiguration read_recording_configuration(const std::filesystem::path& path, bool needs_camera) {
  RecordingConfiguration configuration;
  Json calibration;
  bool names_unit = false;
  read_input_json_file(path, "the configuration of a recording", [&](const Json& json) {
    if (!json.is_object()) throw UsageError("an object expected");
    calibration = json;
    names_unit = json.contains("imu");
    if (!json.contains("recording")) return;
    read_recording(json["recording"], configuration.options);
    calibration.erase("recording");
  });
  CaptureDescription description = parse_capture_json(calibration.dump(), path.string(), {}, needs_camera);
  configuration.calibration = description.calibration;
  configuration.warnings = std::move(description.warnings);
  if (names_unit) {
    configuration.options.acceleration_unit =
        description.acceleration_unit_mps2 == 1.0 ? AccelerationUnit::kMps2 : AccelerationUnit::kG;
  }
  return configuration;
}

}  // namespace cmap

#include "cmap/sim/capture_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "capture/capture_descriptions.hpp"
#include "capture/capture_presets.hpp"
#include "cmap/core/error.hpp"
#include "cmap/core/spelling.hpp"
#include "cmap/io/json_text.hpp"
#include "cmap/io/options_json.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

template <class Options>
void read_section(Options& options, const Json& json, const std::string& name) {
  set_from_json(option_fields(options), json, name);
}

/// The kind decides which other fields there are.
void read_section(SceneChoice& options, const Json& json, const std::string& name) {
  if (json.is_object() && json.contains("kind")) set_from_json(kind_field(options), json.at("kind"), name);
  set_from_json(option_fields(options), json, name);
}

/// A model is where the LiDAR's other fields start from.
void read_section(LidarOptions& options, Json json, const std::string& name) {
  if (json.is_object() && json.contains("model")) {
    if (!json["model"].is_string())
      throw UsageError(fmt::format("{}: model: {} is not a name", name, json["model"].dump()));
    options = lidar_model(json["model"].get<std::string>());
    json.erase("model");
  }
  set_from_json(option_fields(options), json, name);
}

void apply_sections(CaptureOptions& options, const Json& config) {
  if (!config.is_object()) throw UsageError("expected a JSON object of options");
  Json top = Json::object();
  for (const auto& [key, value] : config.items()) {
    bool is_section = false;
    for_each_section(options, [&](const char* name, auto& section) {
      if (key != name) return;
      read_section(section, value, key);
      is_section = true;
    });
    if (!is_section) top[key] = value;
  }
  set_from_json(option_fields(options), top, "capture");
}

Eigen::Matrix3d rotation_of(const Eigen::Vector3d& roll_pitch_yaw_deg) {
  const Eigen::Vector3d a = roll_pitch_yaw_deg * (std::numbers::pi / 180.0);
  return (Eigen::AngleAxisd(a.z(), Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(a.y(), Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(a.x(), Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

}  // namespace

void apply_capture_config(CaptureOptions& options, const std::string& json_text, const std::string& source) {
  read_json(json_text, source, [&](const Json& config) { apply_sections(options, config); });
}

void apply_capture_config_file(CaptureOptions& options, const std::filesystem::path& path) {
  read_json_file(path, "a configuration file", [&](const Json& config) { apply_sections(options, config); });
}

void set_capture_option(CaptureOptions& options, const std::string& assignment) {
  const auto [key, value] = read_assignment(assignment, "section.field=value");
  const std::size_t dot = key.find('.');
  Json config;
  if (dot == std::string::npos) {
    config[key] = value;
  } else {
    config[key.substr(0, dot)][key.substr(dot + 1)] = value;
  }
  apply_sections(options, config);
}

std::vector<std::string> capture_preset_names() {
  std::vector<std::string> names;
  for (const CapturePreset& preset : capture_presets()) names.emplace_back(preset.name);
  return names;
}

void apply_capture_preset(CaptureOptions& options, const std::string& name) {
  for (const CapturePreset& preset : capture_presets()) {
    if (preset.name == name) return apply_capture_config(options, std::string(preset.json), "preset " + name);
  }
  const std::vector<std::string> known = capture_preset_names();
  throw UsageError(
      fmt::format("\"{}\" is no preset{}; presets are {}", name, did_you_mean(name, known), fmt::join(known, ", ")));
}

Json to_json(const CaptureOptions& options) {
  CaptureOptions copy = options;
  Json json = options_json(option_fields(copy));
  for_each_section(copy, [&](const char* name, auto& section) { json[name] = options_json(option_fields(section)); });
  return json;
}

CameraModel camera_of(const CameraOptions& o) {
  CameraModel camera;
  camera.projection = o.projection;
  camera.width = o.width_px;
  camera.height = o.height_px;
  camera.fx = camera.fy = o.focal_px;
  camera.cx = 0.5 * o.width_px + o.center_offset_px.x();
  camera.cy = 0.5 * o.height_px + o.center_offset_px.y();
  camera.distortion = o.distortion;
  return camera;
}

Eigen::Isometry3d T_imu_lidar_of(const MountOptions& o) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = o.lidar_translation_m;
  T.linear() = rotation_of(o.lidar_roll_pitch_yaw_deg);
  return T;
}

Eigen::Isometry3d T_lidar_camera_of(const MountOptions& o) {
  Eigen::Matrix3d optical;  // columns: the camera's right, down, forward in forward, left, up
  optical << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = o.camera_translation_m;
  T.linear() = rotation_of(o.camera_roll_pitch_yaw_deg) * optical;
  return T;
}

}  // namespace cmap

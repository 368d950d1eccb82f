#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "cmap/core/error.hpp"
#include "cmap/io/json_text.hpp"
#include "cmap/io/options_json.hpp"
#include "cmap/lio/lidar_mapping.hpp"
#include "run/odometry_presets.hpp"

namespace cmap {

std::vector<std::string> odometry_preset_names() {
  std::vector<std::string> names;
  for (const OdometryPreset& preset : odometry_presets()) names.emplace_back(preset.name);
  return names;
}

void apply_odometry_preset(OdometryOptions& options, const std::string& name) {
  for (const OdometryPreset& preset : odometry_presets()) {
    if (preset.name != name) continue;
    read_json(std::string(preset.json), "preset " + name,
              [&](const nlohmann::ordered_json& json) { set_from_json(option_fields(options), json); });
    return;
  }
  throw UsageError(fmt::format("no preset {}; there are {}", name, fmt::join(odometry_preset_names(), ", ")));
}

void apply_odometry_config_file(OdometryOptions& options, const std::filesystem::path& path) {
  read_json_file(path, "a configuration file",
                 [&](const nlohmann::ordered_json& json) { set_from_json(option_fields(options), json); });
}

void set_odometry_option(OdometryOptions& options, const std::string& assignment) {
  const OptionAssignment given = read_assignment(assignment, "NAME=VALUE");
  set_from_json(option_fields(options), nlohmann::ordered_json{{given.name, given.value}}, "--set");
}

}  // namespace cmap

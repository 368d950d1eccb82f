#include "cmap/eval/configuration.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "cmap/core/error.hpp"
#include "cmap/core/spelling.hpp"
#include "cmap/io/json_text.hpp"
#include "cmap/io/options_json.hpp"
#include "presets.hpp"

namespace cmap {

void apply_config(EvaluationOptions& options, const std::string& json_text, const std::string& source) {
  read_json(json_text, source, [&](const auto& config) { set_from_json(option_fields(options), config); });
}

void apply_config_file(EvaluationOptions& options, const std::filesystem::path& path) {
  read_json_file(path, "a configuration file",
                 [&](const auto& config) { set_from_json(option_fields(options), config); });
}

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const Preset& preset : presets()) names.emplace_back(preset.name);
  return names;
}

void apply_preset(EvaluationOptions& options, const std::string& name) {
  for (const Preset& preset : presets()) {
    if (preset.name == name) return apply_config(options, std::string(preset.json), "preset " + name);
  }
  throw UsageError(fmt::format("preset: \"{}\" is unknown{}; presets are {}", name, did_you_mean(name, preset_names()),
                               fmt::join(preset_names(), ", ")));
}

}  // namespace cmap

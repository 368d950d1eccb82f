#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cmap/eval/options.hpp"

namespace cmap {

/// Applies a JSON object (comments allowed) of option names and values. Throws UsageError naming `source` and the key:
/// unknown key, wrong type, value out of range.
void apply_config(EvaluationOptions& options, const std::string& json_text, const std::string& source);
void apply_config_file(EvaluationOptions& options, const std::filesystem::path& path);

/// The shipped configurations of configs/: "paper", "indoor", "outdoor", "aerial", "mapeval".
std::vector<std::string> preset_names();
void apply_preset(EvaluationOptions& options, const std::string& name);

}  // namespace cmap

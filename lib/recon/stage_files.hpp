#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

namespace cmap {

/// What the stages of a run found, for a later run to go on from: one JSON file for each stage, with the key of what it
/// was found from. An empty folder name keeps nothing.
class StageFiles {
 public:
  using Json = nlohmann::ordered_json;

  StageFiles(std::filesystem::path folder, bool resume, Json key);

  /// What an earlier run found from the same key; none unless resuming.
  std::optional<Json> load(std::string_view stage) const;
  void save(std::string_view stage, const Json& found) const;

 private:
  std::filesystem::path folder_;
  bool resume_;
  Json key_;
};

}  // namespace cmap

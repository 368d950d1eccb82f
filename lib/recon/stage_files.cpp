#include "stage_files.hpp"

#include <fmt/format.h>

#include <fstream>

#include "cmap/io/output_file.hpp"
#include "cmap/io/output_folder.hpp"

namespace cmap {

namespace fs = std::filesystem;

StageFiles::StageFiles(fs::path folder, bool resume, Json key)
    : folder_(std::move(folder)), resume_(resume), key_(std::move(key)) {}

std::optional<StageFiles::Json> StageFiles::load(std::string_view stage) const {
  if (!resume_ || folder_.empty()) return std::nullopt;
  std::ifstream file(folder_ / fmt::format("{}.json", stage));
  Json json = Json::parse(file, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object() || !json.contains("key") || json["key"] != key_ || !json.contains("found")) return std::nullopt;
  return json["found"];
}

void StageFiles::save(std::string_view stage, const Json& found) const {
  if (folder_.empty()) return;
  make_folder(folder_);
  OutputFile file(folder_ / fmt::format("{}.json", stage));
  file.write(Json{{"key", key_}, {"found", found}}.dump(1) + "\n");
  file.commit();
}

}  // namespace cmap

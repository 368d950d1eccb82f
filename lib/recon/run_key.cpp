#include "run_key.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cmap/core/version.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

}  // namespace

Json run_key(const Capture& capture, const ReconstructionOptions& options, std::optional<std::size_t> only_session) {
  namespace fs = std::filesystem;
  std::vector<std::string> files;
  const auto add = [&](const fs::directory_entry& entry) {
    if (!entry.is_regular_file()) return;
    files.push_back(fmt::format("{} {} {}", entry.path().lexically_relative(capture.folder).string(), entry.file_size(),
                                entry.last_write_time().time_since_epoch().count()));
  };
  // Only what is read: the results may lie in the capture's folder, too.
  for (const char* name : {"capture.json", "lidar.csv", "lio.tum", "imu.csv"})
    add(fs::directory_entry(capture.folder / name));
  for (const StampedFile& scan : capture.scans) add(fs::directory_entry(scan.path));
  for (const auto& entry : fs::directory_iterator(capture.folder / "predictions")) add(entry);
  for (const fs::path& session : capture.sessions) {
    if (!fs::is_directory(session)) continue;
    for (const auto& entry : fs::directory_iterator(session)) add(entry);
  }
  std::ranges::sort(files);
  return {{"version", kVersion},
          {"options", to_json(options)},
          {"only_session", only_session ? Json(*only_session) : Json(nullptr)},
          {"files", files}};
}

}  // namespace cmap

#include "cmap/io/capture.hpp"

#include <algorithm>

#include "io/capture_json.hpp"
#include "io/csv_table.hpp"

namespace cmap {
namespace fs = std::filesystem;
namespace {

std::string read_text_file(const fs::path& path) {
  constexpr std::uint64_t kMost = std::uint64_t{1} << 20;
  ByteSource source(path);
  if (source.size() > kMost) source.fail("{} bytes are too many for a calibration", source.size());
  std::string text(source.size(), '\0');
  source.read(std::as_writable_bytes(std::span(text)), "the file");
  return text;
}

std::vector<StampedFile> read_file_table(const fs::path& folder, const char* name, double offset_s) {
  ByteSource source(folder / name);
  CsvTable table(source, {"timestamp_s", "file"});
  IncreasingTimes times;
  std::vector<StampedFile> files;
  while (table.next()) {
    times.add(table.lines(), table.number(0));
    if (table.cell(1).empty()) table.lines().fail("no file is named");
    const fs::path path = folder / table.cell(1);
    if (!fs::is_regular_file(path)) table.lines().fail("{} is no file", path.string());
    files.push_back({table.number(0) + offset_s, path});
  }
  if (files.empty()) source.fail("lists no file");
  return files;
}

std::vector<ImuSample> read_imu(const fs::path& path, double unit_mps2, double offset_s) {
  ByteSource source(path);
  CsvTable table(source, {"timestamp_s", "gx", "gy", "gz", "ax", "ay", "az"});
  IncreasingTimes times;
  std::vector<ImuSample> samples;
  while (table.next()) {
    times.add(table.lines(), table.number(0));
    const Eigen::Vector3d rate(table.number(1), table.number(2), table.number(3));
    const Eigen::Vector3d force(table.number(4), table.number(5), table.number(6));
    samples.push_back({table.number(0) + offset_s, rate, unit_mps2 * force});
  }
  if (samples.empty()) source.fail("holds no measurement");
  return samples;
}

Trajectory read_lio(const fs::path& path, std::vector<Warning>& warnings) {
  TrajectoryFile file = read_trajectory(path);
  if (!file.has_times) throw InputError(path.string() + ": poses without times; time x y z qx qy qz qw expected");
  warnings.insert(warnings.end(), file.warnings.begin(), file.warnings.end());
  return std::move(file.poses);
}

/// Folders, and NPZ files; other files belong to these. What ends in .partial was never finished.
std::vector<fs::path> find_sessions(const fs::path& folder, std::vector<Warning>& warnings) {
  std::vector<fs::path> sessions;
  if (!fs::exists(folder)) return sessions;
  if (!fs::is_directory(folder)) throw InputError(folder.string() + ": is no folder");
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const fs::path& path = entry.path();
    if (path.filename().string().starts_with(".")) continue;
    if (path.extension() == ".partial") {
      warnings.push_back({"partial_session", path.string() + ": was never finished, and is left out"});
    } else if (entry.is_directory() || path.extension() == ".npz") {
      sessions.push_back(path);
    }
  }
  std::sort(sessions.begin(), sessions.end());
  return sessions;
}

}  // namespace

Capture open_capture(const fs::path& folder) {
  if (!fs::is_directory(folder)) throw InputError(folder.string() + ": is no folder; a capture expected");
  const fs::path description_path = folder / "capture.json";
  CaptureDescription description = parse_capture_json(read_text_file(description_path), description_path.string());
  Capture capture{folder, description.calibration, {}, {}, {}, {}, {}, std::move(description.warnings)};
  capture.images = read_file_table(folder, "images.csv", capture.calibration.image_time_offset_s);
  capture.scans = read_file_table(folder, "lidar.csv", 0.0);
  if (fs::exists(folder / "imu.csv")) {
    capture.imu =
        read_imu(folder / "imu.csv", description.acceleration_unit_mps2, capture.calibration.imu_time_offset_s);
  }
  if (fs::exists(folder / "lio.tum")) capture.lio = read_lio(folder / "lio.tum", capture.warnings);
  capture.sessions = find_sessions(folder / "predictions", capture.warnings);
  return capture;
}

}  // namespace cmap

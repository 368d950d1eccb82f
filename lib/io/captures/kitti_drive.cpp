#include "captures/kitti_drive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>

#include "captures/capture_part.hpp"
#include "captures/kitti_calibration.hpp"
#include "captures/kitti_times.hpp"
#include "cmap/core/error.hpp"
#include "cmap/io/file_place.hpp"
#include "cmap/io/line_reader.hpp"
#include "cmap/io/number_text.hpp"

namespace cmap {
namespace fs = std::filesystem;
namespace {

/// The files of a sensor, each with the time of its number; files may be missing, as some are in published drives.
std::vector<StampedFile> stamped_files(const fs::path& sensor, const char* times_name,
                                       std::initializer_list<std::string_view> extensions) {
  const std::vector<double> times = read_kitti_times(sensor / times_name);
  std::vector<StampedFile> files;
  std::vector<fs::path> paths = paths_in(sensor / "data");
  std::sort(paths.begin(), paths.end());
  for (const fs::path& path : paths) {
    if (std::ranges::find(extensions, path.extension().string()) == extensions.end()) continue;
    const std::size_t number = kitti_number(path);
    if (number >= times.size()) {
      throw InputError(
          fmt::format("{}: {} has only {} times", path.string(), (sensor / times_name).string(), times.size()));
    }
    if (!files.empty() && !(times[number] > files.back().time_s)) {
      throw InputError(fmt::format("{}: line {}: times do not increase", (sensor / times_name).string(), number + 1));
    }
    files.push_back({times[number], path});
  }
  if (files.empty())
    throw InputError(fmt::format("{}: holds no {} file", (sensor / "data").string(), fmt::join(extensions, " or ")));
  return files;
}

/// One line of oxts/data: 30 numbers, of which these are read.
ImuSample read_oxts(const StampedFile& file) {
  constexpr std::size_t kAcceleration = 11, kRate = 17, kLeast = 20;  // ax ay az and wx wy wz: forward, left, up
  ByteSource source(file.path);
  LineReader lines(source);
  std::string_view line;
  if (!lines.next(line)) source.fail("is empty");
  std::vector<double> values;
  for (std::string_view token = next_token(line); !token.empty(); token = next_token(line)) {
    double value = 0.0;
    if (!parse_number(token, value) || !std::isfinite(value))
      lines.fail("'{}' is no finite number", token.substr(0, 40));
    values.push_back(value);
  }
  if (values.size() < kLeast) lines.fail("{} numbers; 30 expected", values.size());
  return {file.time_s, Eigen::Vector3d(&values[kRate]), Eigen::Vector3d(&values[kAcceleration])};
}

std::vector<ImuSample> read_imu(const fs::path& oxts) {
  std::vector<ImuSample> samples;
  for (const StampedFile& file : stamped_files(oxts, "timestamps.txt", {".txt"})) samples.push_back(read_oxts(file));
  return samples;
}

}  // namespace

bool is_kitti_drive(const fs::path& folder) {
  return !is_there(folder / "capture.json") && is_folder(folder / "velodyne_points") && is_folder(folder / "oxts");
}

Capture open_kitti_drive(const fs::path& folder, const CaptureParts& parts, const Faults& faults) {
  Capture capture;
  capture.folder = folder;
  faults.attempt([&] { capture.calibration = read_kitti_calibration(folder); });
  read_part(capture, "image_02", parts.images, faults,
            [&](const Faults&) { capture.images = stamped_files(folder / "image_02", "timestamps.txt", {".png"}); });
  read_part(capture, "velodyne_points", parts.scans, faults, [&](const Faults&) {
    capture.scans = stamped_files(folder / "velodyne_points", "timestamps_start.txt", {".bin", ".txt"});
  });
  read_part(capture, "oxts", parts.imu, faults, [&](const Faults&) { capture.imu = read_imu(folder / "oxts"); });
  return capture;
}

}  // namespace cmap

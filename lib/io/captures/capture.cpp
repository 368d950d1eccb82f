#include "cmap/io/capture.hpp"

#include <algorithm>

#include "bytes/csv_table.hpp"
#include "captures/capture_json.hpp"
#include "captures/capture_part.hpp"
#include "captures/kitti_drive.hpp"
#include "captures/quaternion_order.hpp"
#include "captures/session_files.hpp"
#include "cmap/io/file_place.hpp"
#include "cmap/io/session_file.hpp"
#include "cmap/io/trajectory_file.hpp"

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

std::vector<StampedFile> read_file_table(const fs::path& folder, const char* name, double offset_s,
                                         const Faults& faults) {
  ByteSource source(folder / name);
  CsvTable table(source, {"timestamp_s", "file"});
  IncreasingTimes times;
  std::vector<StampedFile> files;
  bool is_empty = true;
  table.for_each_row(faults, [&] {
    is_empty = false;
    times.add(table.lines(), table.number(0));
    if (table.cell(1).empty()) table.lines().fail("no file is named");
    const fs::path path = folder / table.cell(1);
    if (!is_file(path)) table.lines().fail("{} is no file", path.string());
    files.push_back({table.number(0) + offset_s, path});
  });
  if (is_empty) source.fail("lists no file");
  return files;
}

/// Drivers repeat stamps and hand samples on out of order: they are sorted, and of one time the first counts.
void sort_samples(std::vector<ImuSample>& samples, const std::string& source, std::vector<Warning>& warnings) {
  const auto is_earlier = [](const ImuSample& a, const ImuSample& b) { return a.time_s < b.time_s; };
  const auto is_as_late = [](const ImuSample& a, const ImuSample& b) { return !(a.time_s < b.time_s); };
  if (std::ranges::adjacent_find(samples, is_as_late) == samples.end()) return;
  std::vector<std::string> done;
  if (!std::ranges::is_sorted(samples, is_earlier)) done.push_back("rows were out of order and are sorted");
  std::ranges::stable_sort(samples, is_earlier);
  const std::size_t n = samples.size();
  samples.erase(std::ranges::unique(samples, is_as_late).begin(), samples.end());
  if (samples.size() < n) {
    done.push_back(fmt::format("{} of {} rows repeat the time of another and are left out", n - samples.size(), n));
  }
  warnings.push_back({"imu_times", fmt::format("{}: {}", source, fmt::join(done, "; "))});
}

std::vector<ImuSample> read_imu(const fs::path& path, double unit_mps2, double offset_s, const Faults& faults,
                                std::vector<Warning>& warnings) {
  ByteSource source(path);
  CsvTable table(source, {"timestamp_s", "gx", "gy", "gz", "ax", "ay", "az"});
  std::vector<ImuSample> samples;
  bool is_empty = true;
  table.for_each_row(faults, [&] {
    is_empty = false;
    const Eigen::Vector3d rate(table.number(1), table.number(2), table.number(3));
    const Eigen::Vector3d force(table.number(4), table.number(5), table.number(6));
    samples.push_back({table.number(0) + offset_s, rate, unit_mps2 * force});
  });
  if (is_empty) source.fail("holds no measurement");
  sort_samples(samples, path.string(), warnings);
  return samples;
}

Trajectory read_lio(const fs::path& path, std::vector<Warning>& warnings) {
  TrajectoryFile file = read_trajectory(path);
  if (!file.has_times) throw InputError(path.string() + ": poses without times; time x y z qx qy qz qw expected");
  warnings.insert(warnings.end(), file.warnings.begin(), file.warnings.end());
  return std::move(file.poses);
}

/// One frames.csv cannot be that of several NPZ files, though each would find it.
void require_own_frames(const fs::path& folder, const std::vector<fs::path>& sessions) {
  if (!is_there(folder / "frames.csv")) return;
  std::size_t n_files = 0;
  std::vector<std::string> missing;
  for (const fs::path& session : sessions) {
    if (is_folder(session)) continue;
    ++n_files;
    const fs::path own = own_frames_of(session);
    if (!is_there(own)) missing.push_back(own.filename().string());
  }
  if (n_files < 2 || missing.empty()) return;
  throw InputError(fmt::format("{}: of which session? Beside several .npz each has a table of its own; missing: {}",
                               (folder / "frames.csv").string(), fmt::join(missing, ", ")));
}

/// Folders, and NPZ files; other files belong to these. What ends in .partial was never finished.
std::vector<fs::path> find_sessions(const fs::path& folder, std::vector<Warning>& warnings) {
  std::vector<fs::path> sessions;
  if (!is_there(folder)) return sessions;
  if (!is_folder(folder)) throw InputError(folder.string() + ": is no folder");
  for (const fs::path& path : paths_in(folder)) {
    if (path.filename().string().starts_with(".")) continue;
    if (path.extension() == ".partial") {
      warnings.push_back({"partial_session", path.string() + ": was never finished, and is left out"});
    } else if (is_folder(path) || path.extension() == ".npz") {
      sessions.push_back(path);
    }
  }
  std::sort(sessions.begin(), sessions.end());
  return sessions;
}

}  // namespace

Capture open_capture(const fs::path& folder, const CaptureParts& parts, const Faults& faults) {
  if (!is_folder(folder)) throw InputError(folder.string() + ": is no folder; a capture expected");
  if (is_kitti_drive(folder)) return open_kitti_drive(folder, parts, faults);
  Capture capture;
  capture.folder = folder;
  CaptureDescription description;
  faults.attempt([&] {
    const fs::path path = folder / "capture.json";
    const bool needs_camera = parts.images == Want::kYes || parts.sessions == Want::kYes;
    description = parse_capture_json(read_text_file(path), path.string(), faults, needs_camera);
  });
  capture.calibration = description.calibration;
  capture.warnings = std::move(description.warnings);
  const CaptureCalibration& calibration = capture.calibration;
  read_part(capture, "images.csv", parts.images, faults, [&](const Faults& found) {
    capture.images = read_file_table(folder, "images.csv", calibration.image_time_offset_s, found);
  });
  read_part(capture, "lidar.csv", parts.scans, faults,
            [&](const Faults& found) { capture.scans = read_file_table(folder, "lidar.csv", 0.0, found); });
  const fs::path imu = folder / "imu.csv", lio = folder / "lio.tum", predictions = folder / "predictions";
  read_part(capture, "imu.csv", is_there(imu) ? parts.imu : Want::kNo, faults, [&](const Faults& found) {
    capture.imu =
        read_imu(imu, description.acceleration_unit_mps2, calibration.imu_time_offset_s, found, capture.warnings);
  });
  if (is_there(lio)) {
    faults.attempt([&] {
      capture.lio = read_lio(lio, capture.warnings);
      const std::string fault = quaternion_order_fault(capture.lio, capture.imu);
      if (!fault.empty()) throw InputError(fmt::format("{}: {}", lio.string(), fault));
    });
  }
  if (parts.sessions == Want::kNo) return capture;
  faults.attempt([&] { capture.sessions = find_sessions(predictions, capture.warnings); });
  faults.attempt([&] { require_own_frames(predictions, capture.sessions); });
  return capture;
}

SessionPredictions read_session(const Capture& capture, std::size_t session, const Faults& faults) {
  SessionPredictions predictions = read_session_predictions(capture.sessions.at(session), faults);
  for (PredictionFrame& frame : predictions.frames) frame.time_s += capture.calibration.image_time_offset_s;
  return predictions;
}

}  // namespace cmap

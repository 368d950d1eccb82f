#include <fmt/format.h>

#include <stdexcept>

#include "captures/capture_json.hpp"
#include "cmap/core/error.hpp"
#include "cmap/io/capture.hpp"
#include "cmap/io/lidar_scan_file.hpp"
#include "cmap/io/output_file.hpp"
#include "cmap/io/output_folder.hpp"
#include "cmap/io/session_file.hpp"
#include "cmap/io/trajectory_file.hpp"

namespace cmap {
namespace fs = std::filesystem;
namespace {

void require_increasing(const std::vector<StampedFile>& files, double time_s) {
  if (!files.empty() && !(time_s > files.back().time_s)) {
    throw std::invalid_argument(fmt::format("CaptureWriter: time {} s is not after {} s", time_s, files.back().time_s));
  }
}

void write_text(const fs::path& path, std::string_view text) {
  OutputFile file(path);
  file.write(text);
  file.commit();
}

/// Times as recorded: without the offset that is added on reading.
void write_file_table(const fs::path& path, const std::vector<StampedFile>& files, double offset_s) {
  std::string text = "timestamp_s,file\n";
  for (const StampedFile& file : files) text += fmt::format("{},{}\n", file.time_s - offset_s, file.path.string());
  write_text(path, text);
}

}  // namespace

struct CaptureWriter::State {
  State(const fs::path& folder, const CaptureCalibration& its_calibration)
      : output(folder), calibration(its_calibration) {}

  OutputFolder output;
  CaptureCalibration calibration;
  std::vector<StampedFile> images, scans;  ///< paths within the capture
  std::size_t sessions = 0;
};

CaptureWriter::CaptureWriter(const fs::path& folder, const CaptureCalibration& calibration) {
  check(calibration.camera);
  state_ = std::make_unique<State>(folder, calibration);
}

CaptureWriter::~CaptureWriter() = default;

fs::path CaptureWriter::add_image(double time_s, const std::string& extension) {
  require_increasing(state_->images, time_s);
  const fs::path folder = state_->output.subfolder("images");
  state_->images.push_back({time_s, fmt::format("images/{:06}{}", state_->images.size(), extension)});
  return folder / state_->images.back().path.filename();
}

void CaptureWriter::add_scan(const LidarScan& scan) {
  require_increasing(state_->scans, scan.timestamp_s);
  const fs::path folder = state_->output.subfolder("lidar");
  state_->scans.push_back({scan.timestamp_s, fmt::format("lidar/{:06}.pcd", state_->scans.size())});
  write_lidar_scan(scan, folder / state_->scans.back().path.filename());
}

void CaptureWriter::write_imu(std::span<const ImuSample> samples) {
  OutputFile file(state_->output.partial() / "imu.csv");
  file.write("timestamp_s,gx,gy,gz,ax,ay,az\n");
  for (const ImuSample& sample : samples) {
    const Eigen::Vector3d &rate = sample.angular_rate_radps, &force = sample.specific_force_mps2;
    file.write(fmt::format("{},{},{},{},{},{},{}\n", sample.time_s - state_->calibration.imu_time_offset_s, rate.x(),
                           rate.y(), rate.z(), force.x(), force.y(), force.z()));
  }
  file.commit();
}

void CaptureWriter::write_lio(const Trajectory& world_T_imu) {
  write_tum_trajectory(world_T_imu, state_->output.partial() / "lio.tum");
}

void CaptureWriter::add_session(const SessionPredictions& session) {
  const fs::path folder = state_->output.subfolder("predictions");
  write_session_predictions(session, folder / fmt::format("session_{:04}", state_->sessions++),
                            state_->calibration.image_time_offset_s);
}

fs::path CaptureWriter::subfolder(const std::string& name) { return state_->output.subfolder(name); }

void CaptureWriter::commit() {
  const fs::path& partial = state_->output.partial();
  for (const StampedFile& image : state_->images) {
    if (!fs::exists(partial / image.path)) {
      throw UsageError(fmt::format("{}: was listed in the capture and never written", (partial / image.path).string()));
    }
  }
  write_file_table(partial / "images.csv", state_->images, state_->calibration.image_time_offset_s);
  write_file_table(partial / "lidar.csv", state_->scans, 0.0);
  // Last, as without it nothing is a capture.
  write_text(partial / "capture.json", capture_json(state_->calibration));
  state_->output.commit();
}

}  // namespace cmap

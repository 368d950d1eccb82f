#include "cmap/io/unpack_recording.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cmap/core/error.hpp"
#include "cmap/core/execution.hpp"
#include "cmap/io/output_file.hpp"
#include "recordings/images/png_file.hpp"

namespace cmap {
namespace fs = std::filesystem;
namespace {

/// Gives the messages of a recording to a capture.
class Unpacking {
 public:
  Unpacking(const fs::path& recording, const CaptureCalibration& calibration, const fs::path& capture)
      : name_(recording.string()), calibration_(calibration), writer_(capture, calibration) {}

  void add(const LidarScan& scan) {
    if (scan.positions.empty()) {
      ++empty_scans_;
    } else if (comes_after(scan.timestamp_s, last_scan_s_, late_scans_)) {
      writer_.add_scan(scan);
      ++found_.scans;
    }
  }
  void add(ImuSample sample) {
    sample.time_s += calibration_.imu_time_offset_s;
    imu_.push_back(sample);
  }
  void add(const RecordedImage& image) {
    const double time_s = image.time_s + calibration_.image_time_offset_s;
    if (!comes_after(time_s, last_image_s_, late_images_)) return;
    ++found_.images;
    if (image.encoding != "jpeg" && image.encoding != "png") {
      write_png(rgb_of_raw(image), writer_.add_image(time_s, ".png"));
      return;
    }
    OutputFile file(writer_.add_image(time_s, image.encoding == "png" ? ".png" : ".jpg"));
    file.write(image.bytes.data(), image.bytes.size());
    file.commit();
  }
  void add(const StampedPose& pose) { poses_.push_back(pose); }

  UnpackedRecording finish() {
    put_in_order(imu_, "IMU samples");
    put_in_order(poses_, "poses");
    if (found_.scans == 0 && found_.images == 0 && imu_.empty()) {
      throw InputError(name_ + ": nothing of it is left to be written: no scan with points, no image, no IMU");
    }
    if (!imu_.empty()) writer_.write_imu(imu_);
    if (!poses_.empty()) writer_.write_lio(poses_);
    found_.imu_samples = imu_.size();
    found_.poses = poses_.size();
    warn_of(empty_scans_, "scans without points");
    warn_of(late_scans_, "scans that do not come after the one before");
    warn_of(late_images_, "images that do not come after the one before");
    writer_.commit();
    return std::move(found_);
  }

 private:
  static bool comes_after(double time_s, std::optional<double>& last_s, std::size_t& left_out) {
    if (last_s && !(time_s > *last_s)) {
      ++left_out;
      return false;
    }
    last_s = time_s;
    return true;
  }

  /// By time, of those of equal times the first.
  template <class Stamped>
  void put_in_order(std::vector<Stamped>& values, const char* what) {
    const bool is_sorted = std::ranges::is_sorted(values, {}, &Stamped::time_s);
    std::ranges::stable_sort(values, {}, &Stamped::time_s);
    const auto rest = std::ranges::unique(values, {}, &Stamped::time_s);
    warn_of(rest.size(), fmt::format("{} of a time that another has", what));
    values.erase(rest.begin(), rest.end());
    if (is_sorted) return;
    found_.warnings.push_back(
        {"sorted_by_time", fmt::format("{}: {} were not in the order of their times, and were sorted", name_, what)});
  }

  void warn_of(std::size_t n, const std::string& what) {
    if (n > 0) found_.warnings.push_back({"left_out", fmt::format("{}: left out: {} {}", name_, n, what)});
  }

  std::string name_;
  CaptureCalibration calibration_;
  CaptureWriter writer_;
  UnpackedRecording found_;
  std::vector<ImuSample> imu_;
  Trajectory poses_;
  std::optional<double> last_scan_s_, last_image_s_;
  std::size_t empty_scans_ = 0, late_scans_ = 0, late_images_ = 0;
};

}  // namespace

UnpackedRecording unpack_recording(const fs::path& recording, const RecordingConfiguration& configuration,
                                   const fs::path& capture, const RecordingPart& part) {
  const RecordingOptions& options = configuration.options;
  Recording source(recording, options);
  Unpacking unpacking(recording, configuration.calibration, capture);
  std::optional<double> first_s;
  while (const std::optional<RecordedMessage> message = source.next()) {
    if (!first_s) first_s = source.arrival_time_s();
    const double since_s = source.arrival_time_s() - *first_s;
    if (since_s < part.start_s) continue;
    if (part.duration_s && since_s > part.start_s + *part.duration_s) break;
    std::visit([&](const auto& value) { unpacking.add(value); }, *message);
    report_progress("unpacking", source.done());
  }
  UnpackedRecording found = unpacking.finish();
  const std::vector<Warning> said = source.warnings();
  found.warnings.insert(found.warnings.begin(), said.begin(), said.end());
  found.warnings.insert(found.warnings.begin(), configuration.warnings.begin(), configuration.warnings.end());
  if (source.has_acceleration_in_g() && options.acceleration_unit == AccelerationUnit::kAuto) {
    found.warnings.push_back({"acceleration_in_g", fmt::format("{}: accelerations are about 1, so they are taken for g",
                                                               recording.string())});
  }
  return found;
}

}  // namespace cmap

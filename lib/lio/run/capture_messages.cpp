#include <fmt/format.h>

#include "cmap/core/error.hpp"
#include "cmap/io/lidar_scan_file.hpp"
#include "cmap/lio/lidar_mapping.hpp"

namespace cmap {
namespace {

/// What the accelerations must be multiplied by to be in m/s^2.
double acceleration_factor(const Capture& capture, std::vector<Warning>& warnings) {
  if (capture.imu.empty()) return 1.0;
  double mean = 0.0;
  for (const ImuSample& sample : capture.imu) mean += sample.specific_force_mps2.norm();
  mean /= static_cast<double>(capture.imu.size());
  const std::string file = (capture.folder / "imu.csv").string();
  if (mean > 7.0 && mean < 13.0) return 1.0;
  if (mean > 0.7 && mean < 1.3) {
    warnings.push_back({"imu_in_g", fmt::format("{}: accelerations have a mean length of {:.3f}: taken for g. State it "
                                                "in capture.json: \"imu\": {{\"acceleration_unit\": \"g\"}}",
                                                file, mean)});
    return kStandardGravity_mps2;
  }
  throw InputError(
      fmt::format("{}: accelerations have a mean length of {:.4g}; at rest gravity alone is 9.8 m/s^2, or "
                  "1 g (wrong columns or unit?)",
                  file, mean));
}

}  // namespace

LidarMessages capture_messages(const Capture& capture, std::vector<Warning>& warnings) {
  if (capture.scans.empty()) throw InputError((capture.folder / "lidar.csv").string() + ": no scan to work on");
  const double factor = acceleration_factor(capture, warnings);
  return [&capture, factor, sample = std::size_t{0}, scan = std::size_t{0}]() mutable -> std::optional<LidarMessage> {
    const bool any_sample = sample < capture.imu.size(), any_scan = scan < capture.scans.size();
    if (any_sample && (!any_scan || capture.imu[sample].time_s <= capture.scans[scan].time_s)) {
      ImuSample next = capture.imu[sample++];
      next.specific_force_mps2 *= factor;
      return next;
    }
    if (!any_scan) return std::nullopt;
    const StampedFile& file = capture.scans[scan++];
    return read_lidar_scan(file.path, file.time_s);
  };
}

}  // namespace cmap

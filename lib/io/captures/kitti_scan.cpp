#include "captures/kitti_scan.hpp"

#include <cmath>
#include <numbers>

#include "bytes/little_endian.hpp"
#include "captures/kitti_times.hpp"
#include "cmap/core/error.hpp"
#include "cmap/io/byte_source.hpp"

namespace cmap {
namespace fs = std::filesystem;
namespace {

double turn_duration_s(const fs::path& scan, double start_s) {
  const fs::path ends = scan.parent_path().parent_path() / "timestamps_end.txt";
  const std::vector<double> times = read_kitti_times(ends);
  const std::size_t number = kitti_number(scan);
  if (number >= times.size()) throw InputError(fmt::format("{}: has no time of {}", ends.string(), scan.string()));
  constexpr double kLongest_s = 1.0;
  const double duration_s = times[number] - start_s;
  if (duration_s > 0.0 && duration_s < kLongest_s) return duration_s;
  throw InputError(fmt::format("{}: line {}: the turn that began at {} s ends {:g} s later", ends.string(), number + 1,
                               start_s, duration_s));
}

}  // namespace

bool is_kitti_scan(const fs::path& path) {
  return path.extension() == ".bin" && path.parent_path().filename() == "data" &&
         path.parent_path().parent_path().filename() == "velodyne_points";
}

LidarScan read_kitti_scan(const fs::path& path, double timestamp_s) {
  constexpr std::size_t kPointBytes = 16;
  ByteSource source(path);
  if (source.size() % kPointBytes != 0) source.fail("{} bytes are no whole number of points of 16", source.size());
  const double duration_s = turn_duration_s(path, timestamp_s);
  Array<std::byte> bytes(source.size());
  source.read(bytes, "the points");
  LidarScan scan;
  scan.timestamp_s = timestamp_s;
  for (std::size_t place = 0; place < bytes.size(); place += kPointBytes) {
    const auto value = [&](std::size_t k) { return load_little<float>(bytes, place + 4 * k); };
    const Eigen::Vector3f position(value(0), value(1), value(2));
    if (!position.allFinite() || !std::isfinite(value(3))) continue;
    const double behind =
        std::numbers::pi - std::atan2(static_cast<double>(position.y()), static_cast<double>(position.x()));
    scan.positions.push_back(position);
    scan.intensity.push_back(value(3));
    scan.time_s.push_back(static_cast<float>(duration_s * behind / (2.0 * std::numbers::pi)));
  }
  return scan;
}

}  // namespace cmap

#include "captures/kitti_scan.hpp"

#include <cmath>
#include <numbers>

#include "bytes/little_endian.hpp"
#include "captures/kitti_times.hpp"
#include "cmap/core/error.hpp"
#include "cmap/io/byte_source.hpp"
#include "cmap/io/line_reader.hpp"
#include "cmap/io/number_text.hpp"

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

/// Calls add(x, y, z, intensity) for each point.
template <class Add>
void read_binary_points(ByteSource& source, const Add& add) {
  constexpr std::size_t kPointBytes = 16;
  if (source.size() % kPointBytes != 0) source.fail("{} bytes are no whole number of points of 16", source.size());
  Array<std::byte> bytes(source.size());
  source.read(bytes, "the points");
  const auto value = [&](std::size_t place) { return load_little<float>(bytes, place); };
  for (std::size_t p = 0; p < bytes.size(); p += kPointBytes) add(value(p), value(p + 4), value(p + 8), value(p + 12));
}

template <class Add>
void read_text_points(ByteSource& source, const Add& add) {
  LineReader lines(source);
  std::string_view line;
  while (lines.next(line)) {
    std::array<float, 4> values{};
    std::size_t n = 0;
    for (std::string_view token = next_token(line); !token.empty(); token = next_token(line), ++n) {
      if (n == 4 || !parse_number(token, values[n])) lines.fail("'{}': x y z intensity expected", token.substr(0, 40));
    }
    if (n == 0) continue;
    if (n < 4) lines.fail("{} numbers; x y z intensity expected", n);
    add(values[0], values[1], values[2], values[3]);
  }
}

}  // namespace

bool is_kitti_scan(const fs::path& path) {
  return (path.extension() == ".bin" || path.extension() == ".txt") && path.parent_path().filename() == "data" &&
         path.parent_path().parent_path().filename() == "velodyne_points";
}

LidarScan read_kitti_scan(const fs::path& path, double timestamp_s) {
  const double duration_s = turn_duration_s(path, timestamp_s);
  LidarScan scan;
  scan.timestamp_s = timestamp_s;
  const auto add = [&](float x, float y, float z, float intensity) {
    const Eigen::Vector3f position(x, y, z);
    if (!position.allFinite() || !std::isfinite(intensity)) return;
    const double from_behind = std::numbers::pi - std::atan2(static_cast<double>(y), static_cast<double>(x));
    scan.positions.push_back(position);
    scan.intensity.push_back(intensity);
    scan.time_s.push_back(static_cast<float>(duration_s * from_behind / (2.0 * std::numbers::pi)));
  };
  ByteSource source(path);
  if (path.extension() == ".txt") {
    read_text_points(source, add);
  } else {
    read_binary_points(source, add);
  }
  return scan;
}

}  // namespace cmap

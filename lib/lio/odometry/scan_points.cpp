#include "odometry/scan_points.hpp"

#include <algorithm>
#include <cmath>

#include "cmap/geometry/voxel_map.hpp"

namespace cmap {
namespace {

/// Times from the scan's stamp; empty where all points are of one instant.
std::pair<float, float> first_and_last(const LidarScan& scan) {
  if (scan.time_s.empty()) return {0.0f, 0.0f};
  const auto [first, last] = std::minmax_element(scan.time_s.begin(), scan.time_s.end());
  return {*first, *last};
}

}  // namespace

ScanPoints scan_points(const LidarScan& scan, const OdometryOptions& options) {
  ScanPoints points;
  points.n_measured = scan.positions.size();
  const auto [first, last] = first_and_last(scan);
  points.begin_s = scan.timestamp_s + static_cast<double>(first);
  points.end_s = scan.timestamp_s + static_cast<double>(last);
  points.positions.reserve(scan.positions.size());
  points.before_end_s.reserve(scan.positions.size());
  const auto sq = [](double v) { return static_cast<float>(v * v); };
  const float sq_min = sq(options.min_range_m), sq_max = sq(options.max_range_m);
  for (std::size_t i = 0; i < scan.positions.size(); ++i) {
    const float sq_range = scan.positions[i].squaredNorm();
    if (!(sq_range >= sq_min && sq_range <= sq_max)) continue;
    points.positions.push_back(scan.positions[i]);
    points.before_end_s.push_back(scan.time_s.empty() ? 0.0f : last - scan.time_s[i]);
  }
  return points;
}

std::vector<std::uint32_t> thinned(const std::vector<Eigen::Vector3f>& points, double voxel_m, std::size_t most) {
  VoxelMap<std::uint8_t> seen;
  std::vector<std::uint32_t> first;
  const float per_m = static_cast<float>(1.0 / voxel_m);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3f place = (points[i] * per_m).array().floor();
    std::uint8_t& is_seen = seen[{static_cast<std::int32_t>(place.x()), static_cast<std::int32_t>(place.y()),
                                  static_cast<std::int32_t>(place.z())}];
    if (is_seen == 1) continue;
    is_seen = 1;
    first.push_back(static_cast<std::uint32_t>(i));
  }
  if (first.size() <= most) return first;
  std::vector<std::uint32_t> some(most);
  for (std::size_t k = 0; k < most; ++k) some[k] = first[k * first.size() / most];
  return some;
}

}  // namespace cmap

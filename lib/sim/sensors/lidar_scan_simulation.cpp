#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

#include "capture/option_descriptions.hpp"
#include "cmap/core/parallel.hpp"
#include "cmap/sim/lidar.hpp"
#include "cmap/sim/random_stream.hpp"
#include "sensors/degrees.hpp"

namespace cmap {
namespace {

struct Return {
  Eigen::Vector3f position;
  float intensity;
  float time_s;
  std::uint16_t line;
};

/// The direction turned by two small angles.
Eigen::Vector3d deviated(const Eigen::Vector3d& direction, double sigma_rad, RandomStream& random) {
  const Eigen::Vector3d side = direction.unitOrthogonal(), other = direction.cross(side);
  const double a = random.normal(), b = random.normal();
  return (direction + sigma_rad * (a * side + b * other)).normalized();
}

/// Whether the sensor sees the echo.
bool detected(const LidarOptions& o, double reflectivity, double cos_incidence, double range_m, RandomStream& random) {
  if (o.lossless) return true;
  constexpr double kReference = 0.1;  // of the data sheets
  const double ratio = o.half_detection_range_m / range_m;
  const double power = reflectivity / kReference * cos_incidence * ratio * ratio;
  const double probability = (1.0 - o.lost_fraction) / (1.0 + std::pow(power, -o.detection_steepness));
  return random.uniform() < probability;
}

/// The echo of one shot from the LiDAR's place at that moment.
std::optional<Return> shoot(const Scene& scene, const Eigen::Isometry3d& T_world_lidar, const LidarBeam& beam,
                            const LidarOptions& o, RandomStream random) {
  Eigen::Vector3d direction = beam.direction;
  if (o.angular_noise_deg > 0.0) direction = deviated(direction, kRadPerDeg * o.angular_noise_deg, random);
  const Eigen::Vector3d ray = T_world_lidar.linear() * direction;
  const auto hit = scene.probe(T_world_lidar.translation(), ray, o.max_range_m);
  if (!hit || hit->distance_m < o.min_range_m || !(hit->reflectivity > 0.0f)) return std::nullopt;
  const double cos_incidence = std::abs(hit->normal.cast<double>().dot(ray));
  if (!detected(o, hit->reflectivity, cos_incidence, hit->distance_m, random)) return std::nullopt;
  const double range = hit->distance_m + o.range_noise_m * random.normal();
  const double intensity = std::clamp(std::round(255.0 * hit->reflectivity * cos_incidence), 0.0, 255.0);
  return Return{(range * beam.direction).cast<float>(), static_cast<float>(intensity), beam.time_s, beam.line};
}

LidarScan gathered(const std::vector<std::optional<Return>>& returns, double start_s) {
  LidarScan scan;
  scan.timestamp_s = start_s;
  for (const auto& r : returns) {
    if (!r) continue;
    scan.positions.push_back(r->position);
    scan.intensity.push_back(r->intensity);
    scan.time_s.push_back(r->time_s);
    scan.ring.push_back(r->line);
  }
  return scan;
}

/// Scans are told apart by their start: its bits are the purpose's item.
std::uint64_t scan_seed(std::uint64_t seed, double start_s) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &start_s, sizeof bits);
  return RandomStream(seed, kRandomBeam, bits).bits();
}

}  // namespace

LidarScan simulate_scan(const Scene& scene, const PoseSpline& T_world_imu, const Eigen::Isometry3d& T_imu_lidar,
                        const LidarOptions& options, double start_s, std::uint64_t seed) {
  check_fields(options, "lidar");
  const std::uint64_t own_seed = scan_seed(seed, start_s);
  std::vector<std::optional<Return>> returns(beams_per_scan(options));
  parallel_chunks(returns.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const LidarBeam beam = lidar_beam(options, start_s, i);
      const Eigen::Isometry3d T_world_lidar = T_world_imu.pose(start_s + beam.time_s) * T_imu_lidar;
      returns[i] = shoot(scene, T_world_lidar, beam, options, RandomStream(own_seed, kRandomBeam, i));
    }
  });
  return gathered(returns, start_s);
}

}  // namespace cmap

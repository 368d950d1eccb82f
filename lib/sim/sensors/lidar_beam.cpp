#include <cmath>
#include <numbers>

#include "cmap/sim/lidar.hpp"
#include "sensors/degrees.hpp"

namespace cmap {
namespace {

/// Angle of a rotor, reduced first: a time stamp of today times 100 turns per second would cost digits.
double rotor_rad(double turns_per_s, double time_s, double phase_turns = 0.0) {
  const double turns = turns_per_s * time_s + phase_turns;
  return 2.0 * std::numbers::pi * (turns - std::floor(turns));
}

Eigen::Vector3d from_angles(double azimuth, double elevation) {
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
}

LidarBeam spinning_beam(const LidarOptions& o, std::size_t i) {
  const std::size_t lines = o.elevations_deg.size(), line = i % lines;
  const double turn = static_cast<double>(i) / static_cast<double>(lines * static_cast<std::size_t>(o.azimuth_steps));
  return {from_angles(kRadPerDeg * o.start_azimuth_deg - 2.0 * std::numbers::pi * turn,
                      kRadPerDeg * o.elevations_deg[line]),
          static_cast<float>(turn / o.scan_rate_hz), static_cast<std::uint16_t>(line)};
}

LidarBeam avia_beam(double start_s, double time_s, std::size_t i) {
  constexpr double kPrismDeg = 17.6, kFirstHz = 7294.0 / 60.0, kSecondHz = -4664.0 / 60.0;
  constexpr std::size_t kLines = 6;
  constexpr double kLineDeg = 1.36;
  const std::size_t line = i % kLines;
  const double a = rotor_rad(kFirstHz, start_s + time_s), b = rotor_rad(kSecondHz, start_s + time_s);
  const double left = kPrismDeg * (std::cos(a) + std::cos(b));
  const double up = kPrismDeg * (std::sin(a) + std::sin(b)) + kLineDeg * (static_cast<double>(line) - 2.5);
  const double off = kRadPerDeg * std::hypot(left, up);
  const double share = off > 0.0 ? kRadPerDeg * std::sin(off) / off : 0.0;
  return {{std::cos(off), share * left, share * up}, static_cast<float>(time_s), static_cast<std::uint16_t>(line)};
}

LidarBeam mid360_beam(double start_s, double time_s, std::size_t i) {
  constexpr double kTurnHz = 10.18, kSwingHz = 21.382 * kTurnHz, kMiddleDeg = 22.5, kSwingDeg = 29.5;
  constexpr std::size_t kLines = 4;
  const std::size_t line = i % kLines;
  const double swing = rotor_rad(kSwingHz, start_s + time_s, static_cast<double>(line) / kLines);
  return {from_angles(rotor_rad(kTurnHz, start_s + time_s), kRadPerDeg * (kMiddleDeg + kSwingDeg * std::sin(swing))),
          static_cast<float>(time_s), static_cast<std::uint16_t>(line)};
}

}  // namespace

std::size_t beams_per_scan(const LidarOptions& o) {
  if (o.pattern == LidarPattern::kSpinning) return o.elevations_deg.size() * static_cast<std::size_t>(o.azimuth_steps);
  return static_cast<std::size_t>(o.points_per_s / o.scan_rate_hz);
}

LidarBeam lidar_beam(const LidarOptions& o, double start_s, std::size_t i) {
  if (o.pattern == LidarPattern::kSpinning) return spinning_beam(o, i);
  const double time_s = static_cast<double>(i) / o.points_per_s;
  return o.pattern == LidarPattern::kAviaRosette ? avia_beam(start_s, time_s, i) : mid360_beam(start_s, time_s, i);
}

}  // namespace cmap

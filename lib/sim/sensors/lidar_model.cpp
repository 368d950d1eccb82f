#include <fmt/format.h>

#include "cmap/core/error.hpp"
#include "cmap/sim/lidar.hpp"

namespace cmap {
namespace {

/// `n` elevations from `first` on.
void add_lines(std::vector<double>& elevations_deg, double first, double step, int n) {
  for (int i = 0; i < n; ++i) elevations_deg.push_back(first + step * i);
}

/// VLP-16: 16 lines over 30 deg, 0.2 deg at 10 Hz, 100 m, +-3 cm.
LidarOptions spinning_16() {
  LidarOptions o;
  add_lines(o.elevations_deg, -15.0, 2.0, 16);
  o.azimuth_steps = 1800;
  o.range_noise_m = 0.015;
  o.angular_noise_deg = 0.02;
  return o;
}

/// HDL-32E: 32 lines from -30.67 to 10.67 deg, 0.17 deg at 10 Hz, 100 m, +-2 cm.
LidarOptions spinning_32() {
  LidarOptions o = spinning_16();
  o.elevations_deg.clear();
  add_lines(o.elevations_deg, -92.0 / 3.0, 4.0 / 3.0, 32);
  o.azimuth_steps = 2170;
  o.min_range_m = 1.0;
  o.range_noise_m = 0.01;
  return o;
}

/// HDL-64E S2: 32 lines every 1/3 deg below 2 deg and 32 every 1/2 deg below those, 0.17 deg, 120 m (50 m at 10 %).
LidarOptions spinning_64() {
  LidarOptions o = spinning_16();
  o.elevations_deg.clear();
  add_lines(o.elevations_deg, -8.83 - 15.5, 0.5, 32);
  add_lines(o.elevations_deg, -8.33, 1.0 / 3.0, 32);
  o.azimuth_steps = 2083;
  o.min_range_m = 0.9;
  o.max_range_m = 120.0;
  o.range_noise_m = 0.015;
  return o;
}

/// Avia: 240,000 points/s, 190 m at 10 %, 450 m at most, 2 cm (1 sigma), 0.05 deg, blind below 1 m.
LidarOptions avia() {
  LidarOptions o;
  o.pattern = LidarPattern::kAviaRosette;
  o.points_per_s = 240000;
  o.range_noise_m = 0.02;
  o.angular_noise_deg = 0.05;
  o.min_range_m = 1.0;
  o.max_range_m = 450.0;
  o.half_detection_range_m = 190.0;
  return o;
}

/// Mid-360: 200,000 points/s, 40 m at 10 %, 70 m at 80 %, 2 cm (1 sigma), below 0.15 deg, blind below 0.1 m.
LidarOptions mid360() {
  LidarOptions o;
  o.pattern = LidarPattern::kMid360;
  o.points_per_s = 200000;
  o.range_noise_m = 0.02;
  o.angular_noise_deg = 0.05;
  o.min_range_m = 0.1;
  o.max_range_m = 70.0;
  o.half_detection_range_m = 40.0;
  return o;
}

}  // namespace

std::vector<std::string> lidar_model_names() { return {"spinning_16", "spinning_32", "spinning_64", "avia", "mid360"}; }

LidarOptions lidar_model(const std::string& name) {
  if (name == "spinning_16") return spinning_16();
  if (name == "spinning_32") return spinning_32();
  if (name == "spinning_64") return spinning_64();
  if (name == "avia") return avia();
  if (name == "mid360") return mid360();
  throw UsageError(
      fmt::format("lidar: model: \"{}\" is unknown; models are {}", name, fmt::join(lidar_model_names(), ", ")));
}

}  // namespace cmap

#include "cmap/metrics/exposure_gains.hpp"

#include <array>
#include <stdexcept>
#include <vector>

#include "cmap/geometry/order_statistics.hpp"

namespace cmap {

ExposureGains exposure_gains(const MapPair& pair, double max_distance_m) {
  if (!pair.has_color()) throw std::invalid_argument("exposure_gains: both maps need colors");
  const NearestPairs pairs = pair.estimate_to_reference();
  ExposureGains gains{Eigen::Vector3d::Zero(), 0};
  std::array<std::vector<double>, 3> ratios;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!pairs.is_within(i, max_distance_m) || !pairs.has_colors(i)) continue;
    ++gains.n_pairs;
    const Eigen::Vector3d estimate = pairs.from_color(i);
    const Eigen::Vector3d reference = pairs.to_color(i);
    for (int c = 0; c < 3; ++c) {
      if (estimate[c] != 0.0 && reference[c] != 0.0)
        ratios[static_cast<std::size_t>(c)].push_back(reference[c] / estimate[c]);
    }
  }
  for (int c = 0; c < 3; ++c) {
    gains.gain[c] = quantiles(ratios[static_cast<std::size_t>(c)], std::array{0.5}).front();
  }
  return gains;
}

}  // namespace cmap

#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace cmap {

/// The distances d <= threshold_m of one direction. Mean, RMSE and median are NaN where there are none.
struct WithinThreshold {
  double threshold_m = 0.0;
  std::uint64_t n = 0;
  double mean_m = 0.0;
  double rmse_m = 0.0;
  double median_m = 0.0;
};

/// Everything the geometric metrics need of one direction's nearest distances, from one pass over them.
struct DistanceStats {
  std::uint64_t n = 0;
  double mean_m = 0.0;
  double mean_sq_m2 = 0.0;
  double mean_truncated_m = 0.0;  ///< each distance capped at the truncation
  double max_m = 0.0;
  double p95_m = 0.0;  ///< type-7 percentiles
  double p99_m = 0.0;
  std::vector<WithinThreshold> within;  ///< in the order of the thresholds asked for

  double share_within(std::size_t i) const { return static_cast<double>(within[i].n) / static_cast<double>(n); }
};

/// How far above a threshold a distance counts as at it (spatial/threshold.hpp): of_pair_m(i) for the i-th, never more
/// than most_m, so that only distances that near to a threshold are asked about.
struct DistanceRounding {
  double most_m = 0.0;
  std::function<double(std::size_t)> of_pair_m = {};
};

/// Statistics of d = sqrt(sq_dist); "within" means d <= threshold, up to the rounding, decided in double. The median
/// within is that of as many lowest distances, which differ by the rounding at most. sq_dist must not be empty. Bitwise
/// the same for any number of threads.
DistanceStats distance_stats(std::span<const double> sq_dist, std::span<const double> thresholds_m, double truncation_m,
                             const DistanceRounding& rounding = {});

}  // namespace cmap

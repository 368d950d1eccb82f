#pragma once

// What another tool prints, to lay beside our own numbers (METRICS, "What other tools print"). Every function is
// pure; distances are squared nearest distances in m^2, NaN stands for "no value".

#include <span>

namespace cmap {

/// CloudCompare's cloud-to-cloud distance: mean and population standard deviation of d rounded to float.
struct CloudCompareDistance {
  double mean_m;
  double standard_deviation_m;
};
CloudCompareDistance cloudcompare_distance(std::span<const double> sq_dist);

}  // namespace cmap

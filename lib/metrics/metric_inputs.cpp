#include "cmap/metrics/metric_inputs.hpp"

#include <algorithm>

namespace cmap {

DistanceBands::DistanceBands(const MetricOptions& options) : upper_m_(options.thresholds_m) {
  upper_m_.push_back(options.overlap_distance_m);
  std::ranges::sort(upper_m_);
  const auto doubles = std::ranges::unique(upper_m_);
  upper_m_.erase(doubles.begin(), doubles.end());
}

std::size_t DistanceBands::n_within(double threshold_m) const {
  return static_cast<std::size_t>(std::ranges::upper_bound(upper_m_, threshold_m) - upper_m_.begin());
}

const EnumNames<Singletons>& singletons_names() {
  static const EnumNames<Singletons> names{
      {Singletons::kZero, "zero"}, {Singletons::kExclude, "exclude"}, {Singletons::kRefuse, "refuse"}};
  return names;
}

const EnumNames<GridPhases>& grid_phases_names() {
  static const EnumNames<GridPhases> names{
      {GridPhases::kOne, "1"}, {GridPhases::kEight, "8"}, {GridPhases::kTwentySeven, "27"}};
  return names;
}

}  // namespace cmap

#include "geometry/band_counts.hpp"

#include <fmt/format.h>

#include <numeric>

#include "cmap/metrics/levels.hpp"

namespace cmap {

std::vector<std::string> band_columns(const MetricSettings& settings, const std::string& name) {
  std::vector<std::string> names;
  double lower_m = 0.0;
  for (const double upper_m : settings.bands.upper_m()) {
    names.push_back(fmt::format("{} {}..{}", name, lower_m, upper_m));
    lower_m = upper_m;
  }
  names.push_back(fmt::format("{} {}..", name, lower_m));
  return names;
}

double sum_of_bands(std::span<const double> sums) { return std::accumulate(sums.begin(), sums.end(), 0.0); }

double sum_within(std::span<const double> sums, const MetricSettings& settings, double threshold_m, std::size_t first) {
  return sum_of_bands(sums.subspan(first, settings.bands.n_within(threshold_m)));
}

double share_within(std::span<const double> counts, const MetricSettings& settings, double threshold_m) {
  return sum_within(counts, settings, threshold_m) / sum_of_bands(counts);
}

Record shares_record(std::span<const double> counts, const MetricSettings& settings) {
  std::vector<Record> levels;
  for (const double threshold_m : settings.options.thresholds_m) {
    Record& level =
        levels.emplace_back(Record{.threshold_m = threshold_m, .value = share_within(counts, settings, threshold_m)});
    level.add("n", static_cast<std::uint64_t>(sum_within(counts, settings, threshold_m)));
  }
  Record record;
  record.add("n_points", static_cast<std::uint64_t>(sum_of_bands(counts)));
  return record.add("per_threshold", std::move(levels));
}

void add_share_floors(Record& record, LevelInputs& levels) {
  for (Record& level : record.list_to_change("per_threshold")) add_floor(level, self_share(levels, *level.threshold_m));
}

}  // namespace cmap

#include "metrics/geometry/band_counts.hpp"

#include <fmt/format.h>

#include <numeric>

namespace cmap {
namespace {

double total(std::span<const double> values) { return std::accumulate(values.begin(), values.end(), 0.0); }

}  // namespace

std::vector<std::string> band_columns(const MetricSettings& settings, const std::string& name) {
  std::vector<std::string> names;
  for (const double upper_m : settings.bands.upper_m()) names.push_back(fmt::format("{}<={}", name, upper_m));
  names.push_back(name + " beyond");
  return names;
}

double sum_within(std::span<const double> sums, const MetricSettings& settings, double threshold_m, std::size_t first) {
  return total(sums.subspan(first, settings.bands.n_within(threshold_m)));
}

double share_within(std::span<const double> counts, const MetricSettings& settings, double threshold_m) {
  return sum_within(counts, settings, threshold_m) / total(counts);
}

Record shares_record(std::span<const double> counts, const MetricSettings& settings) {
  std::vector<Record> levels;
  for (const double threshold_m : settings.options.thresholds_m) {
    Record& level =
        levels.emplace_back(Record{.threshold_m = threshold_m, .value = share_within(counts, settings, threshold_m)});
    level.add("n", static_cast<std::uint64_t>(sum_within(counts, settings, threshold_m)));
  }
  Record record;
  record.add("n_points", static_cast<std::uint64_t>(total(counts)));
  return record.add("per_threshold", std::move(levels));
}

}  // namespace cmap

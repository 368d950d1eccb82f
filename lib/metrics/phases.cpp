#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cmap/core/exact_sum.hpp"
#include "cmap/metrics/levels.hpp"
#include "cmap/metrics/metric_sums.hpp"

namespace cmap {

void add_phases(Record& record, std::span<const double> values) {
  if (values.size() < 2) return;
  std::vector<double> known;
  std::ranges::copy_if(values, std::back_inserter(known), [](double v) { return !std::isnan(v); });
  const auto n = static_cast<double>(known.size());
  const auto mean_of = [&](auto term) {
    ExactSum sum;
    for (const double v : known) sum.add(term(v));
    return sum.value() / n;  // 0 / 0 is NaN: missing
  };
  const double mean = mean_of([](double v) { return v; });
  const double variance = mean_of([&](double v) { return (v - mean) * (v - mean); });
  Record phases;
  phases.add("n", std::uint64_t{known.size()}).add("mean", mean).add("std", std::sqrt(variance));
  phases.add("min", known.empty() ? NAN : std::ranges::min(known))
      .add("max", known.empty() ? NAN : std::ranges::max(known));
  record.add("phases", phases.add("values", std::vector<double>(values.begin(), values.end())));
}

void warn_of_phases(std::span<const MetricRecord> records, std::vector<Warning>& warnings) {
  constexpr double kMuch = 0.1;
  std::string found;
  for (const auto& [info, record] : records) {
    const Record* phases = record.part("phases");
    if (phases == nullptr) continue;
    const double mean = *phases->number("mean"), std = *phases->number("std");
    if (!(std > kMuch * mean)) continue;
    found += fmt::format("{}{} is {:.3g} +- {:.2g} ({:.3g} to {:.3g})", found.empty() ? "" : ", ", info->symbol, mean,
                         std, *phases->number("min"), *phases->number("max"));
  }
  if (found.empty()) return;
  warnings.push_back({"grid_phase", fmt::format("values depend on where the grid of voxels starts: over its phases {}; "
                                                "compare maps by these bands, or use smaller voxels",
                                                found)});
}

}  // namespace cmap

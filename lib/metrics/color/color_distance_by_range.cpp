#include <array>

#include "color/color_distance.hpp"
#include "color/color_fields.hpp"

namespace cmap {
namespace {

constexpr std::array kRangeEdges_m{0.0, 0.05, 0.1, 0.2, 0.5, 1.0};
constexpr std::size_t kRanges = kRangeEdges_m.size() - 1;

/// Ranges are (lo, hi], the first with 0; kRanges beyond the last.
std::size_t range_of(const NearestPairs& pairs, std::size_t slot) {
  std::size_t range = 0;
  while (range < kRanges && !pairs.is_within(slot, kRangeEdges_m[range + 1])) ++range;
  return range;
}

/// The columns of one range.
PairSums of_range(const PairSums& sums, std::size_t range) {
  return {sums.estimate.subspan(2 * range, 2), sums.reference.subspan(2 * range, 2)};
}

}  // namespace

namespace catalog {

extern constinit const Metric color_distance_by_range{
    .info = {.id = "color_distance_by_range",
             .title = "color distance by range",
             .group = "color+",
             .unit = "unit RGB",
             .better = "lower",
             .definition = "Color distance of the nearest pairs in bins of their distance in space: separates wrong "
                           "color from wrong geometry.",
             .needs_color = true},
    .columns =
        [](const MetricSettings&) {
          std::vector<std::string> names;
          for (std::size_t range = 0; range < kRanges; ++range) {
            names.push_back("color " + std::to_string(range));
            names.push_back("n " + std::to_string(range));
          }
          return names;
        },
    .add =
        [](const PointRun& run, std::span<ExactSum> sums) {
          const NearestPairs pairs = run.inputs.pairs(run.side);
          for (std::size_t i = 0; i < run.size; ++i) {
            const std::size_t range = range_of(pairs, run.begin + i);
            if (range == kRanges || std::isnan(run.color_distance[i])) continue;
            sums[2 * range].add(run.color_distance[i]);
            sums[2 * range + 1].add(1.0);
          }
        },
    .value =
        [](const PairSums& sums, const MetricSettings&) {
          std::vector<Record> ranges;
          for (std::size_t range = 0; range < kRanges; ++range) {
            const PairSums of = of_range(sums, range);
            Record& record = ranges.emplace_back(Record{.value = mean_color_distance(of)});
            record.add("lo_m", kRangeEdges_m[range]).add("hi_m", kRangeEdges_m[range + 1]);
            add_color_directions(record, of);
            add_color_counts(record, of);
          }
          return Record{}.add("per_range", std::move(ranges));
        },
    .finish = [](Record& record, const MetricInputs& inputs, std::span<const double>,
                 std::vector<Warning>&) { add_without_color(record, inputs); }};

}  // namespace catalog
}  // namespace cmap

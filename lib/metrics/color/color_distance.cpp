#include "color/color_distance.hpp"

#include "cmap/metrics/levels.hpp"
#include "color/color_fields.hpp"
#include "color/color_levels.hpp"

namespace cmap {

void add_color_distances(const PointRun& run, std::span<const double> color_distance, std::span<ExactSum> sums) {
  const std::optional<double>& farthest_m = run.inputs.options().color_max_distance_m;
  const NearestPairs pairs = run.inputs.pairs(run.side);
  std::vector<double> counted;
  counted.reserve(run.size);
  for (std::size_t i = 0; i < run.size; ++i) {
    if (std::isnan(color_distance[i]) || (farthest_m && !pairs.is_within(run.begin + i, *farthest_m))) continue;
    counted.push_back(color_distance[i]);
  }
  sums[kColorColumn].add(counted);
  sums[kColoredPairsColumn].add(static_cast<double>(counted.size()));
}

void add_color_directions(Record& record, const PairSums& sums) {
  record.add("estimate_to_reference", mean_color_distance(sums.estimate));
  record.add("reference_to_estimate", mean_color_distance(sums.reference));
}

void add_color_counts(Record& record, const PairSums& sums) {
  record.add("n_estimate", static_cast<std::uint64_t>(sums.estimate[kColoredPairsColumn]));
  record.add("n_reference", static_cast<std::uint64_t>(sums.reference[kColoredPairsColumn]));
}

namespace catalog {

extern constinit const Metric color_distance{
    .info = {.id = "color_distance",
             .symbol = "CD",
             .title = "color distance",
             .group = "color",
             .unit = "unit RGB",
             .better = "lower",
             .definition = "Mean color difference (L2 norm of RGB) of every point to its nearest point of the other "
                           "map, averaged over both directions.",
             .needs_color = true,
             .paper_factor = 255.0,
             .paper_unit = "of 255"},
    .columns =
        [](const MetricSettings&) {
          return std::vector<std::string>{"color", "n"};
        },
    .add = [](const PointRun& run, std::span<ExactSum> sums) { add_color_distances(run, run.color_distance, sums); },
    .value =
        [](const PairSums& sums, const MetricSettings& settings) {
          Record record{.value = mean_color_distance(sums), .parameters = {max_distance_parameter(settings.options)}};
          record.add("value_8bit", 255.0 * *record.value);
          add_color_directions(record, sums);
          add_color_counts(record, sums);
          return record;
        },
    .finish =
        [](Record& record, const MetricInputs& inputs, std::span<const double>, std::vector<Warning>& warnings) {
          warn_of_no_pairs(record, warnings);
          const MapPair& pair = *inputs.pair;
          add_without_color(record, inputs);
          if (!inputs.options().color_max_distance_m && !record.number("n_without_color_estimate")) return;
          const auto unmatched = [&](const IndexedMap& map, const char* n) {
            return map.size() - static_cast<std::uint64_t>(*record.number(n));
          };
          const std::uint64_t of_estimate = unmatched(pair.estimate, "n_estimate");
          record.add("n_unmatched_estimate", of_estimate);
          record.add("n_unmatched_reference", unmatched(pair.reference, "n_reference"));
        },
    .levels = [](Record& record, LevelInputs& levels,
                 std::vector<Warning>&) { add_levels_of(record, color_distance_levels(levels), "lower"); }};

}  // namespace catalog
}  // namespace cmap

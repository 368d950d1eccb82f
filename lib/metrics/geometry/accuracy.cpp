#include <cmath>

#include "cmap/metrics/levels.hpp"
#include "geometry/band_counts.hpp"

namespace cmap::catalog {

/// Columns: for each band the number of distances, then their sums, then those of their squares.
extern constinit const Metric accuracy{
    .info = {.id = "accuracy",
             .symbol = "AC",
             .title = "accuracy",
             .group = "geometry",
             .unit = "m",
             .better = "lower",
             .definition =
                 "Root mean square of the distances to the reference that are at most the threshold, over the "
                 "estimated points that have such.",
             .per_threshold = true},
    .sides = Sides::kEstimate,
    .columns =
        [](const MetricSettings& settings) {
          std::vector<std::string> names = band_columns(settings, "n");
          for (const char* more : {"distance", "sq_distance"}) {
            for (const std::string& name : band_columns(settings, more)) names.push_back(name);
          }
          return names;
        },
    .add =
        [](const PointRun& run, std::span<ExactSum> sums) {
          const std::size_t n_bands = run.inputs.settings.bands.size();
          for (std::size_t band = 0; band < n_bands; ++band) {
            const std::span<const double> distances = run.distances_in(band);
            sums[band].add(static_cast<double>(distances.size()));
            sums[n_bands + band].add(distances);
            sums[2 * n_bands + band].add(run.squares_in(band));
          }
        },
    .value =
        [](const PairSums& sums, const MetricSettings& settings) {
          const std::size_t n_bands = settings.bands.size();
          std::vector<Record> levels;
          for (const double t : settings.options.thresholds_m) {
            const double n = sum_within(sums.estimate, settings, t);  // 0 / 0 is NaN: missing
            const double square = sum_within(sums.estimate, settings, t, 2 * n_bands);
            Record& level = levels.emplace_back(Record{.threshold_m = t, .value = std::sqrt(square / n)});
            level.add("mean", sum_within(sums.estimate, settings, t, n_bands) / n);
            level.add("n", static_cast<std::uint64_t>(n));
          }
          return Record{}.add("per_threshold", std::move(levels));
        },
    // The median within is that of as many lowest distances, which differ by the rounding at most.
    .quantiles =
        [](const PairSums& sums, const MetricInputs& inputs) {
          std::vector<DistanceQuantile> medians;
          for (const double t : inputs.options().thresholds_m) {
            const double n = sum_within(sums.estimate, inputs.settings, t);
            medians.push_back({Side::kEstimate, static_cast<std::uint64_t>(n), 0.5});
          }
          return medians;
        },
    .finish =
        [](Record& record, const MetricInputs&, std::span<const double> medians, std::vector<Warning>&) {
          std::vector<Record>& levels = record.list_to_change("per_threshold");
          for (std::size_t t = 0; t < levels.size(); ++t) levels[t].add("median", medians[t]);
        },
    .levels =
        [](Record& record, LevelInputs& levels, std::vector<Warning>&) {
          for (Record& level : record.list_to_change("per_threshold")) {
            add_floor(level, rms_level(self_distances(levels, level.threshold_m)));
          }
        }};

}  // namespace cmap::catalog

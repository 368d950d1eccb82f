#include "cmap/metrics/catalog.hpp"
#include "cmap/metrics/geometry.hpp"
#include "cmap/metrics/levels.hpp"
#include "geometry/band_counts.hpp"

namespace cmap {

double f_score(double precision, double recall) {
  const double sum = precision + recall;  // NaN where either is
  return sum == 0.0 ? 0.0 : 2.0 * precision * recall / sum;
}

namespace catalog {

extern constinit const Metric f_score{
    .info = {.id = "f_score",
             .symbol = "F",
             .title = "F-score",
             .group = "geometry",
             .unit = "1",
             .better = "higher",
             .definition = "Harmonic mean of fitness and completeness.",
             .per_threshold = true,
             .share = true},
    .sums_of = &fitness,
    .value =
        [](const PairSums& sums, const MetricSettings& settings) {
          std::vector<Record> levels;
          for (const double t : settings.options.thresholds_m) {
            const double precision = share_within(sums.estimate, settings, t);
            const double recall = share_within(sums.reference, settings, t);
            Record& level = levels.emplace_back(Record{.threshold_m = t, .value = cmap::f_score(precision, recall)});
            level.add("precision", precision).add("recall", recall);
          }
          return Record{}.add("per_threshold", std::move(levels));
        },
    .levels = [](Record& record, LevelInputs& levels, std::vector<Warning>&) { add_share_floors(record, levels); }};

}  // namespace catalog
}  // namespace cmap

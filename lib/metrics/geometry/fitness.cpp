#include "cmap/metrics/levels.hpp"
#include "geometry/band_counts.hpp"

namespace cmap::catalog {

extern constinit const Metric fitness{
    .info = {.id = "fitness",
             .symbol = "COM",
             .title = "fitness (precision)",
             .group = "geometry",
             .unit = "1",
             .better = "higher",
             .definition = "Share of estimated points within the threshold of the reference (precision).",
             .per_threshold = true,
             .share = true},
    .columns = [](const MetricSettings& settings) { return band_columns(settings, "n"); },
    .add =
        [](const PointRun& run, std::span<ExactSum> sums) {
          for (std::size_t band = 0; band < sums.size(); ++band) {
            sums[band].add(static_cast<double>(run.distances_in(band).size()));
          }
        },
    .value = [](const PairSums& sums,
                const MetricSettings& settings) { return shares_record(sums.estimate, settings); },
    .levels = [](Record& record, LevelInputs& levels, std::vector<Warning>&) { add_share_floors(record, levels); }};

}  // namespace cmap::catalog

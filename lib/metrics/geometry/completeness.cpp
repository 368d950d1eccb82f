#include "cmap/metrics/catalog.hpp"
#include "cmap/metrics/levels.hpp"
#include "geometry/band_counts.hpp"

namespace cmap::catalog {

extern constinit const Metric completeness{
    .info = {.id = "completeness",
             .title = "completeness (recall)",
             .group = "geometry",
             .unit = "1",
             .better = "higher",
             .definition = "Share of reference points within the threshold of the estimate (recall).",
             .per_threshold = true,
             .share = true},
    .sums_of = &fitness,
    .value = [](const PairSums& sums,
                const MetricSettings& settings) { return shares_record(sums.reference, settings); },
    .levels = [](Record& record, LevelInputs& levels, std::vector<Warning>&) { add_share_floors(record, levels); }};

}  // namespace cmap::catalog

#include "cmap/metrics/catalog.hpp"
#include "cmap/metrics/levels.hpp"
#include "geometry/band_counts.hpp"

namespace cmap::catalog {

extern constinit const Metric overlap{
    .info = {.id = "overlap",
             .symbol = "Overlap",
             .title = "overlap",
             .group = "geometry",
             .unit = "1",
             .better = "higher",
             .definition = "Share of estimated points within the overlap distance of the reference.",
             .share = true,
             .paper_factor = 100.0,
             .paper_unit = "%"},
    .sums_of = &fitness,
    .value =
        [](const PairSums& sums, const MetricSettings& settings) {
          const double distance_m = settings.options.overlap_distance_m;
          const double n = sum_within(sums.estimate, settings, distance_m);
          const double share = share_within(sums.estimate, settings, distance_m);
          Record record{.value = share, .parameters = {{"overlap_distance_m", distance_m}}};
          record.add("n", static_cast<std::uint64_t>(n));
          return record.add("n_estimate", static_cast<std::uint64_t>(sum_of_bands(sums.estimate)));
        },
    .levels =
        [](Record& record, LevelInputs& levels, std::vector<Warning>&) {
          add_floor(record, self_share(levels, levels.inputs.options().overlap_distance_m));
        }};

}  // namespace cmap::catalog

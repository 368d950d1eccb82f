#include <cmath>

#include "cmap/metrics/catalog.hpp"
#include "cmap/metrics/levels.hpp"
#include "geometry/band_counts.hpp"

namespace cmap::catalog {

extern constinit const Metric rmse{
    .info = {.id = "rmse",
             .symbol = "RMSE",
             .title = "RMSE",
             .group = "geometry",
             .unit = "m",
             .better = "lower",
             .definition = "Root mean square distance of all estimated points to the reference; inlier_rmse: of those "
                           "within the overlap distance."},
    .sums_of = &accuracy,
    .value =
        [](const PairSums& sums, const MetricSettings& settings) {
          const std::size_t n_bands = settings.bands.size();
          const double distance_m = settings.options.overlap_distance_m;
          const double n = sum_of_bands(sums.estimate.first(n_bands));
          const double n_inliers = sum_within(sums.estimate, settings, distance_m);
          Record record{.value = std::sqrt(sum_of_bands(sums.estimate.subspan(2 * n_bands)) / n),
                        .parameters = {{"overlap_distance_m", distance_m}}};
          const double inlier_squares = sum_within(sums.estimate, settings, distance_m, 2 * n_bands);
          record.add("inlier_rmse", std::sqrt(inlier_squares / n_inliers));
          record.add("n", static_cast<std::uint64_t>(n));
          return record.add("n_inliers", static_cast<std::uint64_t>(n_inliers));
        },
    .levels = [](Record& record, LevelInputs& levels,
                 std::vector<Warning>&) { add_floor(record, rms_level(self_distances(levels))); }};

}  // namespace cmap::catalog

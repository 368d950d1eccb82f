#include <algorithm>
#include <cmath>

#include "cmap/metrics/geometry.hpp"
#include "cmap/metrics/levels.hpp"
#include "cmap/metrics/metric.hpp"

namespace cmap {
namespace {

enum ChamferColumn : std::size_t { kChamferPoints, kDistance, kSquare, kTruncated };

}  // namespace

MeanDistances mean_distances(std::span<const double> chamfer_sums) {
  const double n = chamfer_sums[kChamferPoints];
  return {n, chamfer_sums[kDistance] / n, chamfer_sums[kSquare] / n, chamfer_sums[kTruncated] / n};
}

namespace catalog {

extern constinit const Metric chamfer{
    .info = {.id = "chamfer",
             .symbol = "CD#",
             .title = "Chamfer distance",
             .group = "geometry",
             .unit = "m",
             .better = "lower",
             .definition =
                 "Mean distance of estimated points to the reference plus mean distance of reference points to "
                 "the estimate."},
    .columns =
        [](const MetricSettings&) {
          return std::vector<std::string>{"n", "distance", "sq_distance", "truncated"};
        },
    .add =
        [](const PointRun& run, std::span<ExactSum> sums) {
          const double most_m = run.inputs.options().overlap_distance_m;
          std::vector<double> truncated(run.distance_m.begin(), run.distance_m.end());
          for (double& d : truncated) d = std::min(d, most_m);
          sums[kChamferPoints].add(static_cast<double>(run.size));
          sums[kDistance].add(run.distance_m);
          sums[kSquare].add(run.sq_dist);
          sums[kTruncated].add(truncated);
        },
    .value =
        [](const PairSums& sums, const MetricSettings& settings) {
          const MeanDistances e = mean_distances(sums.estimate), r = mean_distances(sums.reference);
          const double l1_sum = e.mean_m + r.mean_m;
          Record record{.value = l1_sum, .parameters = {{"overlap_distance_m", settings.options.overlap_distance_m}}};
          record.add("estimate_to_reference", e.mean_m).add("reference_to_estimate", r.mean_m);
          record.add("n_estimate", static_cast<std::uint64_t>(e.n)).add("n_reference", static_cast<std::uint64_t>(r.n));
          Record variants;
          variants.add("l1_sum", l1_sum).add("l1_mean", 0.5 * l1_sum).add("l2sq_sum", e.mean_sq_m2 + r.mean_sq_m2);
          variants.add("l2_rms_mean", 0.5 * (std::sqrt(e.mean_sq_m2) + std::sqrt(r.mean_sq_m2)));
          return record.add("variants", variants.add("truncated_l1_sum", e.mean_truncated_m + r.mean_truncated_m));
        },
    .levels = [](Record& record, LevelInputs& levels,
                 std::vector<Warning>&) { add_floor(record, scaled(mean_level(self_distances(levels)), 2.0)); }};

}  // namespace catalog
}  // namespace cmap

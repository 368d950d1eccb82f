#include <algorithm>

#include "cmap/metrics/metric.hpp"

namespace cmap::catalog {

/// No sum: there is no value of a part or of a bootstrap's draw.
extern constinit const Metric hausdorff{
    .info = {.id = "hausdorff",
             .title = "Hausdorff distance",
             .group = "geometry",
             .unit = "m",
             .better = "lower",
             .definition = "Largest distance of any point to the other map; 95th and 99th percentiles beside it."},
    .quantiles =
        [](const PairSums&, const MetricInputs& inputs) {
          std::vector<DistanceQuantile> wanted;
          for (const Side side : inputs.sides()) {
            for (const double share : {1.0, 0.95, 0.99}) wanted.push_back({side, inputs.map(side).size(), share});
          }
          return wanted;
        },
    .finish =
        [](Record& record, const MetricInputs&, std::span<const double> q, std::vector<Warning>&) {
          record.value = std::max(q[0], q[3]);
          record.add("estimate_to_reference", Record{}.add("max", q[0]).add("p95", q[1]).add("p99", q[2]));
          record.add("reference_to_estimate", Record{}.add("max", q[3]).add("p95", q[4]).add("p99", q[5]));
        }};

}  // namespace cmap::catalog

#include <array>

#include "cmap/core/parallel.hpp"
#include "cmap/metrics/metric.hpp"
#include "color/color_fields.hpp"

namespace cmap {
namespace {

/// Over the pairs that have both colors; NaN of none.
double median_distance(const NearestPairs& pairs) {
  std::vector<double> distances(pairs.size());
  parallel_chunks(pairs.size(), kLoopChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t slot = begin; slot < end; ++slot) distances[slot] = pairs.color_distance(slot);
  });
  return quantiles_of_numbers(distances, std::array{0.5}).front();
}

}  // namespace

namespace catalog {

/// A median: there is no value of a part or of a bootstrap's draw.
extern constinit const Metric median_color_distance{
    .info = {.id = "median_color_distance",
             .title = "median color distance",
             .group = "color+",
             .unit = "unit RGB",
             .better = "lower",
             .definition = "Median color difference (L2 norm of RGB) of the points to their nearest of the other map, "
                           "averaged over both directions: half of the points are no worse, however wrong the rest is.",
             .needs_color = true},
    .finish = [](Record& record, const MetricInputs& inputs, std::span<const double>, std::vector<Warning>&) {
      const double estimate = median_distance(inputs.pairs(Side::kEstimate));
      const double reference = median_distance(inputs.pairs(Side::kReference));
      record.value = 0.5 * (estimate + reference);
      record.add("estimate_to_reference", estimate).add("reference_to_estimate", reference);
      add_without_color(record, inputs);
    }};

}  // namespace catalog
}  // namespace cmap

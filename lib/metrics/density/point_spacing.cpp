#include "cmap/metrics/point_spacing.hpp"

#include "cmap/metrics/metric.hpp"

namespace cmap {
namespace {

Record spacing_record(const PointSpacing& spacing) {
  Record record{.value = spacing.median_m};
  return record.add("mean", spacing.mean_m).add("n", spacing.n).add("n_copies", spacing.n_copies);
}

}  // namespace

namespace catalog {

/// A median: there is no value of a part or of a bootstrap's draw.
extern constinit const Metric point_spacing{
    .info = {.id = "point_spacing",
             .title = "point spacing",
             .group = "density",
             .unit = "m",
             .definition =
                 "Median distance from a point to the nearest other one, copies counted once: the smaller, the "
                 "denser the map. Needs no reference.",
             .needs_reference = false},
    .finish = [](Record& record, const MetricInputs& inputs, std::span<const double>, std::vector<Warning>& warnings) {
      const PointSpacing spacing = cmap::point_spacing(inputs.estimate.index);
      if (spacing.n < 2) {
        warnings.push_back({"point_spacing_one_place", "all points are at one place: no point spacing"});
      }
      record = spacing_record(spacing);
      if (inputs.pair == nullptr) return;
      record.add("reference", spacing_record(cmap::point_spacing(inputs.pair->reference.index)));
    }};

}  // namespace catalog
}  // namespace cmap

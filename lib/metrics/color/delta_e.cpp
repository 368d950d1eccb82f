#include <array>

#include "cmap/core/parallel.hpp"
#include "cmap/geometry/color.hpp"
#include "cmap/metrics/levels.hpp"
#include "cmap/metrics/metric.hpp"
#include "color/color_fields.hpp"
#include "color/color_levels.hpp"

namespace cmap {
namespace {

/// CIEDE2000 of the pairs no farther than the radius of LCR; NaN of others.
Array<double> differences(const NearestPairs& pairs, double max_distance_m) {
  Array<double> values(pairs.size(), NAN);
  parallel_chunks(pairs.size(), kLoopChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (pairs.is_within(i, max_distance_m) && pairs.has_colors(i)) values[i] = pairs.delta_e(i);
    }
  });
  return values;
}

Record mean_difference(std::span<const double> sums) {
  return Record{}.add("mean", sums[0] / sums[1]).add("n", static_cast<std::uint64_t>(sums[1]));
}

void add_quantiles(Record& direction, const Array<double>& differences) {
  const std::vector<double> ranked = quantiles_of_numbers(differences, std::array{0.5, 0.95});
  direction.add("median", ranked[0]).add("p95", ranked[1]);
}

}  // namespace

namespace catalog {

extern constinit const Metric delta_e{
    .info = {.id = "delta_e",
             .symbol = "dE00",
             .title = "CIEDE2000",
             .group = "color+",
             .unit = "1",
             .better = "lower",
             .definition = "Perceived color difference (CIEDE2000) of nearest pairs within the radius of LCR: mean, "
                           "median and 95th percentile of both directions.",
             .needs_color = true},
    .prepare =
        [](MetricInputs& inputs) {
          for (const Side side : inputs.sides()) {
            inputs.delta_e.of(side) = differences(inputs.pairs(side), inputs.options().lcr_radius_m);
          }
        },
    .columns =
        [](const MetricSettings&) {
          return std::vector<std::string>{"delta_e", "n"};
        },
    .add =
        [](const PointRun& run, std::span<ExactSum> sums) {
          const Array<double>& differences = run.inputs.delta_e.of(run.side);
          for (std::size_t slot = run.begin; slot < run.begin + run.size; ++slot) {
            if (std::isnan(differences[slot])) continue;
            sums[0].add(differences[slot]);
            sums[1].add(1.0);
          }
        },
    .value =
        [](const PairSums& sums, const MetricSettings& settings) {
          Record record{.value = 0.5 * (sums.estimate[0] / sums.estimate[1] + sums.reference[0] / sums.reference[1]),
                        .parameters = {{"radius_m", settings.options.lcr_radius_m}}};
          record.add("estimate_to_reference", mean_difference(sums.estimate));
          return record.add("reference_to_estimate", mean_difference(sums.reference));
        },
    .finish =
        [](Record& record, const MetricInputs& inputs, std::span<const double>, std::vector<Warning>&) {
          add_quantiles(record.part_to_change("estimate_to_reference"), inputs.delta_e.estimate);
          add_quantiles(record.part_to_change("reference_to_estimate"), inputs.delta_e.reference);
          add_without_color(record, inputs);
        },
    .levels =
        [](Record& record, LevelInputs& levels, std::vector<Warning>&) {
          const auto lab = [](const Eigen::Vector3d& color) { return srgb_to_lab(color / 255.0); };
          add_levels_of(record, difference_levels(levels, levels.inputs.options().lcr_radius_m, lab, delta_e_2000),
                        "lower");
        }};

}  // namespace catalog
}  // namespace cmap

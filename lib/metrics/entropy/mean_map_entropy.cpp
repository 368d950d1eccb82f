#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "cmap/metrics/metric.hpp"

namespace cmap {
namespace {

enum EntropyColumn : std::size_t { kEntropy, kEntropies, kLeftOut, kFlat };

bool has_enough(const NeighborhoodShape& shape, std::size_t slot, std::uint64_t min_neighbors) {
  return shape.n_neighbors[slot] >= min_neighbors && !std::isnan(shape.covariance_det[slot]);
}

/// 1/2 ln((2 pi e)^3 det C)
double entropy_of(double covariance_det) {
  static const double kConstant = 3.0 * std::log(2.0 * std::numbers::pi * std::numbers::e);
  return 0.5 * (kConstant + std::log(covariance_det));
}

Record entropy_record(std::span<const double> sums) {
  Record record{.value = sums[kEntropy] / sums[kEntropies]};
  record.add("n", static_cast<std::uint64_t>(sums[kEntropies]));
  record.add("n_left_out", static_cast<std::uint64_t>(sums[kLeftOut]));
  return record.add("n_flat", static_cast<std::uint64_t>(sums[kFlat]));
}

Warning why_no_entropy(const MetricOptions& options, double n_flat) {
  if (n_flat == 0.0) {
    return {"mean_map_entropy_no_points",
            fmt::format("no point of the evaluated map has {} neighbors within {} m: no mean map entropy",
                        options.mme_min_neighbors, options.mme_radius_m)};
  }
  return {"mean_map_entropy_flat",
          fmt::format("the neighbors within {} m of all {} points that have enough are flat to the rounding of their "
                      "coordinates: no mean map entropy",
                      options.mme_radius_m, n_flat)};
}

}  // namespace

namespace catalog {

/// The point itself is no neighbor. Points of too few neighbors are left out, and so are those whose neighbors are flat
/// to the rounding of their coordinates: the entropy would be the rounding's.
extern constinit const Metric mean_map_entropy{
    .info = {.id = "mean_map_entropy",
             .symbol = "MME",
             .title = "mean map entropy",
             .group = "mme",
             .unit = "nats",
             .better = "lower",
             .definition = "Mean entropy of the Gaussian of every point's neighborhood, where that is not flat to the "
                           "rounding of its coordinates: lower is crisper. Needs no reference.",
             .needs_reference = false},
    .prepare =
        [](MetricInputs& inputs) {
          if (inputs.neighborhoods.estimate) return;
          for (const Side side : inputs.sides()) {
            const IndexedMap& map = inputs.map(side);
            inputs.neighborhoods.of(side) =
                neighborhood_shapes(map.index, inputs.options().mme_radius_m, map.file_step_m);
          }
        },
    .columns =
        [](const MetricSettings&) {
          return std::vector<std::string>{"entropy", "n", "left_out", "flat"};
        },
    .add =
        [](const PointRun& run, std::span<ExactSum> sums) {
          const NeighborhoodShape& shape = *run.inputs.neighborhoods.of(run.side);
          for (std::size_t slot = run.begin; slot < run.begin + run.size; ++slot) {
            if (!has_enough(shape, slot, run.inputs.options().mme_min_neighbors)) {
              sums[kLeftOut].add(1.0);
            } else if (shape.is_flat[slot] != 0) {
              sums[kFlat].add(1.0);
            } else {
              sums[kEntropy].add(entropy_of(shape.covariance_det[slot]));
              sums[kEntropies].add(1.0);
            }
          }
        },
    .value =
        [](const PairSums& sums, const MetricSettings& settings) {
          Record record = entropy_record(sums.estimate);
          record.parameters = {{"radius_m", settings.options.mme_radius_m},
                               {"min_neighbors", settings.options.mme_min_neighbors}};
          if (!sums.reference.empty()) record.add("reference", entropy_record(sums.reference));
          return record;
        },
    .finish =
        [](Record& record, const MetricInputs& inputs, std::span<const double>, std::vector<Warning>& warnings) {
          if (std::isnan(*record.value)) {
            warnings.push_back(why_no_entropy(inputs.options(), *record.number("n_flat")));
          }
        }};

}  // namespace catalog
}  // namespace cmap

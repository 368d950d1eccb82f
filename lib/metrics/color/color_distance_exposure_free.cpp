#include "color/color_distance.hpp"
#include "color/color_fields.hpp"

namespace cmap {
namespace {

/// The run's color distances with the gains on the estimate's colors.
std::vector<double> distances_with_gain(const PointRun& run, const Eigen::Vector3d& gain) {
  const NearestPairs pairs = run.inputs.pairs(run.side);
  const Eigen::Vector3d one = Eigen::Vector3d::Ones();
  const bool from_estimate = run.side == Side::kEstimate;
  std::vector<double> distances(run.size);
  for (std::size_t i = 0; i < run.size; ++i) {
    const std::size_t slot = run.begin + i;
    distances[i] =
        pairs.has_colors(slot)
            ? pairs.color_difference(slot, from_estimate ? gain : one, from_estimate ? one : gain).norm() / 255.0
            : NAN;
  }
  return distances;
}

}  // namespace

namespace catalog {

extern constinit const Metric color_distance_exposure_free{
    .info = {.id = "color_distance_exposure_free",
             .title = "color distance, exposure-free",
             .group = "color+",
             .unit = "unit RGB",
             .better = "lower",
             .definition =
                 "Color distance after the best gain of every channel on the estimate: what is left without a "
                 "difference in exposure.",
             .needs_color = true},
    .prepare = [](MetricInputs& inputs) { inputs.gains = exposure_gains(*inputs.pair, inputs.options().lcr_radius_m); },
    .columns =
        [](const MetricSettings&) {
          return std::vector<std::string>{"color", "n"};
        },
    .add =
        [](const PointRun& run, std::span<ExactSum> sums) {
          add_color_distances(run, distances_with_gain(run, run.inputs.gains->gain), sums);
        },
    .value =
        [](const PairSums& sums, const MetricSettings& settings) {
          Record record{
              .value = mean_color_distance(sums),
              .parameters = {max_distance_parameter(settings.options), {"radius_m", settings.options.lcr_radius_m}}};
          add_color_directions(record, sums);
          return record;
        },
    .finish =
        [](Record& record, const MetricInputs& inputs, std::span<const double>, std::vector<Warning>& warnings) {
          warn_of_no_pairs(record, warnings);
          const Eigen::Vector3d& gain = inputs.gains->gain;
          record.add("gains", std::vector{gain.x(), gain.y(), gain.z()});
          record.add("n_pairs", inputs.gains->n_pairs);
          add_without_color(record, inputs);
        }};

}  // namespace catalog
}  // namespace cmap

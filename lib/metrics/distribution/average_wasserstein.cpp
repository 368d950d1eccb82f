#include "cmap/geometry/order_statistics.hpp"
#include "cmap/metrics/levels.hpp"
#include "cmap/metrics/metric.hpp"
#include "distribution/wasserstein_field.hpp"

namespace cmap {
namespace {

/// The median, and the distribution in steps of a twentieth.
void add_distribution(Record& record, std::span<const VoxelDistance> voxels) {
  constexpr std::size_t kSteps = 20;
  std::vector<double> distances, shares;
  for (const VoxelDistance& voxel : voxels) distances.push_back(voxel.distance_m);
  for (std::size_t i = 0; i <= kSteps; ++i) shares.push_back(static_cast<double>(i) / static_cast<double>(kSteps));
  const std::vector<double> ranked = quantiles(distances, shares);
  record.add("median", ranked[kSteps / 2]);
  std::vector<Record> cumulative;
  for (std::size_t i = 0; i <= kSteps && !distances.empty(); ++i) {
    cumulative.push_back(Record{}.add("share", shares[i]).add("value_m", ranked[i]));
  }
  record.add("cumulative", std::move(cumulative));
}

}  // namespace

namespace catalog {

extern constinit const Metric average_wasserstein{
    .info = {.id = "average_wasserstein",
             .symbol = "AWD",
             .title = "average Wasserstein distance",
             .group = "distribution",
             .unit = "m",
             .better = "lower",
             .definition =
                 "Mean over voxels that both maps fill of the 2-Wasserstein distance between the Gaussians of "
                 "their points."},
    .prepare = prepare_wasserstein,
    .sides = Sides::kEstimate,
    .columns =
        [](const MetricSettings&) {
          return std::vector<std::string>{"n", "distance"};
        },
    .each_voxel =
        [](const MetricInputs& inputs, Side, const std::function<void(const VoxelTerms&)>& use) {
          for (const VoxelDistance& voxel : wasserstein_voxels(inputs)) {
            const double terms[]{1.0, voxel.distance_m};
            use({voxel.index, inputs.options().awd_voxel_m, terms});
          }
        },
    .value =
        [](const PairSums& sums, const MetricSettings& settings) {
          Record record{.value = sums.estimate[1] / sums.estimate[0],
                        .parameters = wasserstein_parameters(settings.options)};
          return record.add("n_voxels", static_cast<std::uint64_t>(sums.estimate[0]));
        },
    .finish =
        [](Record& record, const MetricInputs& inputs, std::span<const double>, std::vector<Warning>& warnings) {
          warn_of_no_voxels(inputs, warnings);
          add_distribution(record, wasserstein_voxels(inputs));
          std::vector<double> means;
          for (const auto& voxels : inputs.wasserstein->by_phase) means.push_back(mean_distance(voxels));
          add_phases(record, means);
        },
    .levels =
        [](Record& record, LevelInputs& levels, std::vector<Warning>&) {
          const MetricOptions& o = levels.inputs.options();
          add_floor(record, halves_level(levels.inputs.wasserstein->of_halves, o.awd_voxel_m, o.awd_min_points));
        }};

}  // namespace catalog
}  // namespace cmap

#include <cmath>

#include "cmap/metrics/levels.hpp"
#include "cmap/metrics/metric.hpp"
#include "distribution/wasserstein_field.hpp"

namespace cmap::catalog {

extern constinit const Metric spatial_consistency{
    .info = {.id = "spatial_consistency",
             .symbol = "SCS",
             .title = "spatial consistency",
             .group = "distribution",
             .unit = "1",
             .better = "lower",
             .definition = "How unevenly the Wasserstein distances are spread: standard deviation over mean among "
                           "neighboring voxels, averaged."},
    .prepare =
        [](MetricInputs& inputs) {
          prepare_wasserstein(inputs);
          const auto radius = static_cast<int>(inputs.options().scs_radius_voxels);
          for (const auto& voxels : inputs.wasserstein->by_phase) {
            inputs.variations.push_back(local_variations(voxels, radius));
          }
        },
    .sides = Sides::kEstimate,
    .columns =
        [](const MetricSettings&) {
          return std::vector<std::string>{"n", "variation"};
        },
    .each_voxel =
        [](const MetricInputs& inputs, Side, const std::function<void(const VoxelTerms&)>& use) {
          const std::vector<double>& variations = inputs.variations.front();
          for (std::size_t i = 0; i < variations.size(); ++i) {
            if (std::isnan(variations[i])) continue;
            const double terms[]{1.0, variations[i]};
            use({wasserstein_voxels(inputs)[i].index, inputs.options().awd_voxel_m, terms});
          }
        },
    .value =
        [](const PairSums& sums, const MetricSettings& settings) {
          Record record{.value = sums.estimate[1] / sums.estimate[0],
                        .parameters = wasserstein_parameters(settings.options)};
          record.parameters.push_back({"radius_voxels", settings.options.scs_radius_voxels});
          return record.add("n_voxels", static_cast<std::uint64_t>(sums.estimate[0]));
        },
    .finish =
        [](Record& record, const MetricInputs& inputs, std::span<const double>, std::vector<Warning>& warnings) {
          warn_of_no_voxels(inputs, warnings);
          std::vector<double> means;
          for (const std::vector<double>& variations : inputs.variations) means.push_back(mean_variation(variations));
          add_phases(record, means);
          if (!std::isnan(*record.value) || wasserstein_voxels(inputs).empty()) return;
          warnings.push_back({"spatial_consistency_no_voxels",
                              "no voxel has other voxels at a Wasserstein distance above 0 around it: no SCS"});
        }};

}  // namespace cmap::catalog

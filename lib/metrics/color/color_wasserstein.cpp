#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cmap/core/parallel.hpp"
#include "cmap/core/random_hash.hpp"
#include "cmap/metrics/levels.hpp"
#include "cmap/metrics/metric.hpp"
#include "color/color_fields.hpp"

namespace cmap {
namespace {

std::uint64_t n_colored(const IndexedMap& map) { return map.size() - map.n_without_color; }

/// The share of the points with a color that lie in the voxels.
double share_in(std::span<const ColoredVoxel> voxels, const IndexedMap& map, Side side) {
  std::uint64_t n = 0;
  for (const ColoredVoxel& voxel : voxels) n += side == Side::kEstimate ? voxel.n_estimate : voxel.n_reference;
  return static_cast<double>(n) / static_cast<double>(n_colored(map));
}

void warn_of_few_voxels(const Record& record, const MetricInputs& inputs, std::vector<Warning>& warnings) {
  const MetricOptions& o = inputs.options();
  const double of_estimate = *record.number("share_estimate"), of_reference = *record.number("share_reference");
  if (std::min(of_estimate, of_reference) >= 0.5) return;
  const std::optional<double> voxel_m = voxel_of_half(*inputs.pair, o.cw_voxel_m, o.cw_min_points);
  const std::string remedy = voxel_m ? fmt::format("--cw-voxel {:.3g} reaches half of the points of both", *voxel_m)
                                     : "no size reaches half, as the maps have little in common";
  const bool none = record.number("n_voxels") == 0.0;
  warnings.push_back({none ? "color_wasserstein_no_voxels" : "color_wasserstein_sparse",
                      fmt::format("color Wasserstein sees {:.3g} % of the estimate's points and {:.3g} % of the "
                                  "reference's: voxels of {} m that hold {} points of both; {}",
                                  100.0 * of_estimate, 100.0 * of_reference, o.cw_voxel_m, o.cw_min_points, remedy)});
}

/// The Gaussian of n colors drawn with replacement.
Gaussian drawn_gaussian(const std::vector<Eigen::Vector3d>& colors, std::uint64_t n, std::uint64_t seed) {
  const Eigen::Vector3d first = colors.front();  // about which is summed
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  for (std::uint64_t i = 0; i < n; ++i) {
    const Eigen::Vector3d d = colors[random_below(colors.size(), i, seed)] - first;
    sum += d;
    products.noalias() += d * d.transpose();
  }
  const auto count = static_cast<double>(n);
  return {n, (first + sum / count) / 255.0, (products - sum * sum.transpose() / count) / (255.0 * 255.0)};
}

/// The mean over voxels of five draws each, of as many of the estimate's colors as a voxel has points.
Level drawn_chance(LevelInputs& levels, const std::string& too_few) {
  constexpr int kDraws = 5;
  constexpr std::size_t kVoxelChunk = 64;
  const std::vector<Eigen::Vector3d>& colors = levels.estimate_colors();
  const std::vector<ReferenceColors>& voxels = levels.inputs.color_wasserstein->sample;
  std::vector<double> means(voxels.size());
  parallel_chunks(voxels.size(), kVoxelChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (std::uint64_t draw = 0; draw < kDraws; ++draw) {
        const Gaussian drawn = drawn_gaussian(colors, voxels[i].n_estimate, voxels[i].seed + draw);
        means[i] += wasserstein_distance(voxels[i].reference, drawn) / kDraws;
      }
    }
  });
  if (means.empty()) return {.reason = too_few};
  return mean_level(means);
}

}  // namespace

namespace catalog {

extern constinit const Metric color_wasserstein{
    .info = {.id = "color_wasserstein",
             .symbol = "CW",
             .title = "color Wasserstein",
             .group = "color",
             .unit = "unit RGB",
             .better = "lower",
             .definition =
                 "Mean over voxels that both maps fill of the 2-Wasserstein distance between the Gaussians of "
                 "their colors: neither color noise nor gray improves it.",
             .needs_color = true},
    .prepare =
        [](MetricInputs& inputs) {
          const MetricOptions& o = inputs.options();
          inputs.color_wasserstein =
              cmap::color_wasserstein(*inputs.pair, phase_options(o, o.cw_voxel_m, o.cw_min_points));
        },
    .sides = Sides::kEstimate,
    .columns =
        [](const MetricSettings&) {
          return std::vector<std::string>{"n", "distance"};
        },
    .each_voxel =
        [](const MetricInputs& inputs, Side, const std::function<void(const VoxelTerms&)>& use) {
          for (const ColoredVoxel& voxel : inputs.color_wasserstein->voxels) {
            const double terms[]{1.0, voxel.distance};
            use({voxel.index, inputs.options().cw_voxel_m, terms});
          }
        },
    .value =
        [](const PairSums& sums, const MetricSettings& settings) {
          const MetricOptions& o = settings.options;
          Record record{.value = sums.estimate[1] / sums.estimate[0],
                        .parameters = {{"voxel_m", o.cw_voxel_m}, {"min_points", o.cw_min_points}}};
          return record.add("n_voxels", static_cast<std::uint64_t>(sums.estimate[0]));
        },
    .finish =
        [](Record& record, const MetricInputs& inputs, std::span<const double>, std::vector<Warning>& warnings) {
          const std::vector<ColoredVoxel>& voxels = inputs.color_wasserstein->voxels;
          record.add("share_estimate", share_in(voxels, inputs.estimate, Side::kEstimate));
          record.add("share_reference", share_in(voxels, inputs.pair->reference, Side::kReference));
          add_without_color(record, inputs);
          add_phases(record, inputs.color_wasserstein->phase_means);
          warn_of_few_voxels(record, inputs, warnings);
        },
    .levels =
        [](Record& record, LevelInputs& levels, std::vector<Warning>&) {
          const MetricOptions& o = levels.inputs.options();
          Levels both;
          both.floor = halves_level(levels.inputs.color_wasserstein->of_halves, o.cw_voxel_m, o.cw_min_points);
          both.chance = drawn_chance(
              levels, fmt::format("no voxel of {} m holds {} points of both maps", o.cw_voxel_m, o.cw_min_points));
          add_levels_of(record, both, "lower");
        }};

}  // namespace catalog
}  // namespace cmap

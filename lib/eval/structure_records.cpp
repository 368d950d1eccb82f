#include <fmt/format.h>

#include "cmap/metrics/mean_map_entropy.hpp"
#include "eval/json_number.hpp"
#include "eval/metric_records.hpp"
#include "eval/record_list.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

Json voxel_parameters(const EvaluationOptions& o) {
  return {{"voxel_m", o.awd_voxel_m}, {"min_points", o.awd_min_points}};
}

Json wasserstein_fields(const EvaluationOptions& options, const AverageWasserstein& awd) {
  Json cumulative = Json::array();
  for (std::size_t i = 0; i < awd.quantiles_m.size() && awd.n_voxels > 0; ++i) {
    cumulative.push_back({{"share", static_cast<double>(i) / 20.0}, {"value_m", awd.quantiles_m[i]}});
  }
  return {{"value", json_number(awd.mean_m)},
          {"median", json_number(awd.median_m)},
          {"parameters", voxel_parameters(options)},
          {"n_voxels", awd.n_voxels},
          {"cumulative", cumulative}};
}

Json consistency_fields(const EvaluationOptions& options, const SpatialConsistency& scs) {
  Json parameters{{"radius_voxels", options.scs_radius_voxels}};
  parameters.update(voxel_parameters(options));
  return {{"value", json_number(scs.value)}, {"parameters", parameters}, {"n_voxels", scs.n_voxels}};
}

Json entropy_numbers(const EvaluationOptions& options, const NeighborhoodShape& shape) {
  const MeanMapEntropy mme = mean_map_entropy(shape, options.mme_min_neighbors);
  return {{"value", json_number(mme.value)}, {"n", mme.n}, {"n_left_out", mme.n_left_out}, {"n_flat", mme.n_flat}};
}

Warning why_no_entropy(const EvaluationOptions& options, std::uint64_t n_flat) {
  if (n_flat == 0) {
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

std::vector<MetricRecord> distribution_records(const Findings& f, std::vector<Warning>& warnings) {
  RecordList records(f.selection);
  const std::vector<VoxelDistance> distances = wasserstein_distances(f.gaussians);
  records.add("average_wasserstein", [&] {
    if (distances.empty()) {
      warnings.push_back(
          {"average_wasserstein_no_voxels", fmt::format("no {} m voxel holds {} points of both maps: no AWD and no SCS",
                                                        f.options.awd_voxel_m, f.options.awd_min_points)});
    }
    return wasserstein_fields(f.options, average_wasserstein(distances));
  });
  records.add("spatial_consistency", [&] {
    const SpatialConsistency scs = spatial_consistency(distances, static_cast<int>(f.options.scs_radius_voxels));
    if (scs.n_voxels == 0 && !distances.empty()) {
      warnings.push_back({"spatial_consistency_no_voxels",
                          "no voxel has other voxels at a Wasserstein distance above 0 around it: no SCS"});
    }
    return consistency_fields(f.options, scs);
  });
  return records.take();
}

Json mean_map_entropy_fields(const EvaluationOptions& options, const NeighborhoodShape& neighborhoods,
                             std::vector<Warning>& warnings) {
  Json fields = entropy_numbers(options, neighborhoods);
  if (fields["value"].is_null()) warnings.push_back(why_no_entropy(options, fields["n_flat"]));
  fields["parameters"] = {{"radius_m", options.mme_radius_m}, {"min_neighbors", options.mme_min_neighbors}};
  return fields;
}

std::vector<MetricRecord> entropy_records(const Findings& f, std::vector<Warning>& warnings) {
  RecordList records(f.selection);
  records.add("mean_map_entropy", [&] {
    Json fields = mean_map_entropy_fields(f.options, f.neighborhoods->estimate, warnings);
    fields["reference"] = entropy_numbers(f.options, f.neighborhoods->reference);
    return fields;
  });
  return records.take();
}

}  // namespace cmap

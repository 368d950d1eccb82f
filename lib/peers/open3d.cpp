#include "cmap/peers/open3d.hpp"

#include <cmath>

#include "cmap/peers/cloudanalyzer.hpp"
#include "cmap/peers/peer_tool.hpp"
#include "distances.hpp"

namespace cmap {

Open3dRegistration open3d_registration(std::span<const double> sq_dist, double threshold_m) {
  double sum = 0.0;
  std::uint64_t n_inliers = 0;
  for (const double sq : sq_dist) {
    if (sq >= threshold_m * threshold_m) continue;
    sum += sq;
    ++n_inliers;
  }
  if (n_inliers == 0) return {0.0, 0.0, 0};
  return {static_cast<double>(n_inliers) / static_cast<double>(sq_dist.size()),
          std::sqrt(sum / static_cast<double>(n_inliers)), n_inliers};
}

namespace {

Record open3d_record(MetricInputs& inputs, const PeerOptions&) {
  std::vector<Record> levels;
  for (const double threshold_m : inputs.options().thresholds_m) {
    const Open3dRegistration r = open3d_registration(peer_distances(inputs, Side::kEstimate), threshold_m);
    Record& level = levels.emplace_back(Record{.threshold_m = threshold_m});
    level.add("fitness", r.fitness).add("inlier_rmse", r.inlier_rmse_m).add("correspondences", r.n_correspondences);
  }
  const auto mean = [&](Side side) { return cloudanalyzer_summary(peer_distances(inputs, side)).mean_m; };
  Record record;
  record.add("definition", "Open3D 0.16 evaluate_registration, compute_point_cloud_distance");
  record.add("per_threshold", std::move(levels));
  return record.add("mean_distance", Record{}
                                         .add("estimate_to_reference", mean(Side::kEstimate))
                                         .add("reference_to_estimate", mean(Side::kReference)));
}

}  // namespace

namespace peers {

extern constinit const PeerTool open3d{.name = "open3d", .record = open3d_record};

}  // namespace peers
}  // namespace cmap

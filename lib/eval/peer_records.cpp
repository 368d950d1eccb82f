#include "eval/peer_records.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "cmap/align/tanks_and_temples.hpp"
#include "cmap/core/color.hpp"
#include "cmap/metrics/color_consistency.hpp"
#include "cmap/metrics/color_distance.hpp"
#include "cmap/metrics/geometry.hpp"
#include "cmap/metrics/peers.hpp"
#include "eval/cloud_of.hpp"
#include "eval/json_number.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

/// MapEval's least neighbors in the reference; mme-min-neighbors is the estimate's.
constexpr std::uint64_t kMapEvalReferenceNeighbors = 5;

Json mapeval_record(const Findings& f) {
  const MapEvalAccuracy accuracy =
      mapeval_accuracy(f.pair.nearest_in_reference.sq_dist, f.options.thresholds_m, f.options.overlap_distance_m);
  Json levels = Json::array();
  for (std::size_t t = 0; t < f.options.thresholds_m.size(); ++t) {
    levels.push_back({{"threshold_m", f.options.thresholds_m[t]},
                      {"AC", json_number(accuracy.accuracy_m[t])},
                      {"COM", accuracy.completeness[t]}});
  }
  const std::vector<VoxelDistance> distances = mapeval_wasserstein_distances(f.gaussians);
  const MapEvalEntropy estimate = mapeval_entropy(f.neighborhoods->estimate, f.options.mme_min_neighbors);
  const MapEvalEntropy reference = mapeval_entropy(f.neighborhoods->reference, kMapEvalReferenceNeighbors);
  return {{"definition", "MapEval 1.0.0 with its initial matrix only"},
          {"per_threshold", levels},
          {"n_correspondences", accuracy.n_correspondences},
          {"AWD", json_number(average_wasserstein(distances).mean_m)},
          {"SCS", json_number(spatial_consistency(distances, static_cast<int>(f.options.scs_radius_voxels)).value)},
          {"n_voxels", distances.size()},
          {"MME",
           {{"estimate", json_number(estimate.value)},
            {"reference", json_number(reference.value)},
            {"valid_estimate", estimate.n_valid},
            {"valid_reference", reference.n_valid}}}};
}

Json open3d_record(const Findings& f) {
  Json levels = Json::array();
  for (double threshold : f.options.thresholds_m) {
    const Open3dRegistration r = open3d_registration(f.pair.nearest_in_reference.sq_dist, threshold);
    levels.push_back({{"threshold_m", threshold},
                      {"fitness", r.fitness},
                      {"inlier_rmse", r.inlier_rmse_m},
                      {"correspondences", r.n_correspondences}});
  }
  return {{"definition", "Open3D 0.16 evaluate_registration, compute_point_cloud_distance"},
          {"per_threshold", levels},
          {"mean_distance",
           {{"estimate_to_reference", f.estimate_to_reference.mean_m},
            {"reference_to_estimate", f.reference_to_estimate.mean_m}}}};
}

Json cloudcompare_record(const Findings& f) {
  const CloudCompareDistance d = cloudcompare_distance(f.pair.nearest_in_reference.sq_dist);
  return {{"definition", "CloudCompare 2.11 -C2C_DIST, estimate compared with reference"},
          {"mean", d.mean_m},
          {"std", d.standard_deviation_m}};
}

MpegCloud mpeg_cloud(const IndexedMap& map) {
  MpegCloud cloud;
  for (std::size_t slot = 0; slot < map.size(); ++slot) {
    cloud.positions.push_back(map.index.points.offset(slot));
    cloud.rgb.push_back(to_rgb8(color_at(map.colors, slot)));
  }
  return cloud;
}

/// Tools that know no points without color get none.
bool every_point_has_color(const MapPair& pair) {
  return pair.has_color() && pair.reference.n_without_color + pair.estimate.n_without_color == 0;
}

Json color_map_evaluation_record(const Findings& f, std::vector<Warning>& warnings) {
  if (!every_point_has_color(f.pair)) {
    warnings.push_back({"color_map_evaluation_needs_color",
                        "Color-Map-Evaluation's numbers need a color at every point of both maps: null"});
    return nullptr;
  }
  constexpr double kVoxel_m = 0.1, kTau = 0.1, kRadius_m = 0.5;  // its defaults
  const double cd = color_distance(f.pair).value(), cf_db = color_fidelity_db(cd);
  const LocalColorRecall recall = local_color_recall(f.pair, {.tau = kTau, .radius_m = kRadius_m, .radius_steps = 0.0});
  return {{"definition",
           "Color-Map-Evaluation 0.1.0 at its defaults: tau 0.1, radius 0.5 m, voxels of 0.1 m, singletons zero"},
          {"CD", cd},
          {"CD_rgb255", 255.0 * cd},
          {"CF_dB", std::isinf(cf_db) ? Json("+inf") : Json(cf_db)},
          {"LCR", recall.value()},
          {"LCR_percent", 100.0 * recall.value()},
          {"CCS", color_consistency(f.pair.estimate, kVoxel_m, 2).zero}};
}

Json cloudanalyzer_evaluate(const Findings& f) {
  const std::span<const double> estimate = f.pair.nearest_in_reference.sq_dist;
  const std::span<const double> reference = f.pair.nearest_in_estimate.sq_dist;
  const CloudAnalyzerCurve curve = cloudanalyzer_curve(estimate, reference);
  const CloudAnalyzerSummary forth = cloudanalyzer_summary(estimate), back = cloudanalyzer_summary(reference);
  const auto summary = [](const CloudAnalyzerSummary& s) -> Json {
    return {{"mean", s.mean_m}, {"median", s.median_m}, {"max", s.max_m}, {"std", s.standard_deviation_m}};
  };
  Json scores = Json::array();
  for (const CloudAnalyzerScore& s : curve.scores) {
    scores.push_back({{"threshold", s.threshold_m}, {"precision", s.precision}, {"recall", s.recall}, {"f1", s.f1}});
  }
  return {{"source_points", estimate.size()},
          {"target_points", reference.size()},
          {"chamfer_distance", 0.5 * (forth.mean_m + back.mean_m)},
          {"hausdorff_distance", std::max(forth.max_m, back.max_m)},
          {"f1_scores", scores},
          {"auc", curve.auc},
          {"distance_stats", {{"source_to_target", summary(forth)}, {"target_to_source", summary(back)}}}};
}

/// Without voxels it prints neither AWD nor SCS.
Json cloudanalyzer_map_evaluate(const Findings& f) {
  constexpr double kVoxel_m = 3.0;  // its defaults
  constexpr std::uint64_t kMinPoints = 100;
  constexpr int kRadiusVoxels = 5;
  constexpr std::array kThresholds_m{0.2, 0.1, 0.08, 0.05, 0.01};
  const DistanceStats forth = distance_stats(f.pair.nearest_in_reference.sq_dist, kThresholds_m, kThresholds_m[0]);
  const DistanceStats back = distance_stats(f.pair.nearest_in_estimate.sq_dist, kThresholds_m, kThresholds_m[0]);
  Json fields{{"n_est", forth.n},
              {"n_ref", back.n},
              {"mean_est_to_ref_m", forth.mean_m},
              {"mean_ref_to_est_m", back.mean_m},
              {"chamfer_m", forth.mean_m + back.mean_m}};
  for (std::size_t t = 0; t < kThresholds_m.size(); ++t) {
    fields[fmt::format("accuracy@{:.3f}m", kThresholds_m[t])] = forth.share_within(t);
    fields[fmt::format("completeness@{:.3f}m", kThresholds_m[t])] = back.share_within(t);
  }
  fields[fmt::format("fscore@{:.3f}m", kThresholds_m[0])] = f_score(forth.share_within(0), back.share_within(0));
  const CloudAnalyzerStructure structure =
      cloudanalyzer_structure(gaussian_pairs(f.pair, kVoxel_m, kMinPoints), kRadiusVoxels);
  if (std::isfinite(structure.awd_m)) fields["awd_m"] = structure.awd_m;
  if (std::isfinite(structure.scs)) fields["scs"] = structure.scs;
  fields["n_awd_voxels"] = structure.n_awd_voxels;
  fields["n_scs_voxels"] = structure.n_scs_voxels;
  return fields;
}

Json cloudanalyzer_record(const Findings& f) {
  return {{"definition", "CloudAnalyzer 0.6.0 at its defaults: commands evaluate and map-evaluate"},
          {"evaluate", cloudanalyzer_evaluate(f)},
          {"map-evaluate", cloudanalyzer_map_evaluate(f)}};
}

Json mpeg_record(const Findings& f, std::vector<Warning>& warnings) {
  if (!every_point_has_color(f.pair)) {
    warnings.push_back({"mpeg_needs_color", "pc_error's color numbers need a color at every point of both maps: null"});
    return nullptr;
  }
  const auto direction = [](const MpegDirection& d) -> Json {
    Json psnr = Json::array();
    for (double db : d.color_psnr_db) psnr.push_back(json_number(db));
    return {{"point_mse", d.point_mse_m2},
            {"hausdorff_squared", d.sq_hausdorff_m2},
            {"color_mse", d.color_mse},
            {"color_psnr", psnr}};
  };
  const MpegDistortion d = mpeg_distortion(mpeg_cloud(f.pair.reference), mpeg_cloud(f.pair.estimate));
  return {{"definition", "mpeg-pcc-dmetric 0.14 pc_error, point to point and color (BT.709, peak 1)"},
          {"reference_to_estimate", direction(d.reference_to_estimate)},
          {"estimate_to_reference", direction(d.estimate_to_reference)},
          {"symmetric", direction(d.symmetric)}};
}

Json tanks_and_temples_record(const Findings& f) {
  TanksAndTemplesOptions options;
  options.tau_m = tanks_and_temples_tau_m(f.options);
  options.crop = f.options.crop;
  const TanksAndTemplesResult r =
      tanks_and_temples(cloud_of(f.pair.estimate), cloud_of(f.pair.reference), Eigen::Matrix4d::Identity(), options);
  return {{"definition", "Tanks and Temples toolbox: three stages of ICP with scale, clouds thinned to tau / 2"},
          {"tau_m", options.tau_m},
          {"precision", r.precision},
          {"recall", r.recall},
          {"f_score", r.f_score},
          {"n_estimate", r.n_source},
          {"n_reference", r.n_target},
          {"scale", r.alignment.scale}};
}

}  // namespace

Json peer_records(const Findings& f, std::vector<Warning>& warnings) {
  Json records;
  for (const std::string& tool : f.options.as) {
    if (tool == "color-map-evaluation") records[tool] = color_map_evaluation_record(f, warnings);
    if (tool == "cloudanalyzer") records[tool] = cloudanalyzer_record(f);
    if (tool == "mapeval") records[tool] = mapeval_record(f);
    if (tool == "open3d") records[tool] = open3d_record(f);
    if (tool == "cloudcompare") records[tool] = cloudcompare_record(f);
    if (tool == "tanksandtemples") records[tool] = tanks_and_temples_record(f);
    if (tool == "mpeg") records[tool] = mpeg_record(f, warnings);
  }
  return records;
}

}  // namespace cmap

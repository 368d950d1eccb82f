#include "eval/peer_records.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "cmap/align/tanks_and_temples.hpp"
#include "cmap/core/color.hpp"
#include "cmap/metrics/catalog.hpp"
#include "cmap/metrics/geometry.hpp"
#include "cmap/metrics/peers.hpp"
#include "eval/cloud_of.hpp"

namespace cmap {
namespace {

/// MapEval's least neighbors in the reference; mme-min-neighbors is the estimate's.
constexpr std::uint64_t kMapEvalReferenceNeighbors = 5;

std::span<const double> distances(const MetricInputs& inputs, Side side) { return inputs.pairs(side).nearest.sq_dist; }

/// Tools that know no points without color get none.
bool every_point_has_color(const MapPair& pair) {
  return pair.has_color() && pair.reference.n_without_color + pair.estimate.n_without_color == 0;
}

Record mapeval_record(MetricInputs& inputs) {
  for (const Metric* metric : {&catalog::average_wasserstein, &catalog::mean_map_entropy}) metric->prepare(inputs);
  const MetricOptions& o = inputs.options();
  const MapEvalAccuracy accuracy =
      mapeval_accuracy(distances(inputs, Side::kEstimate), o.thresholds_m, o.overlap_distance_m);
  std::vector<Record> levels;
  for (std::size_t t = 0; t < o.thresholds_m.size(); ++t) {
    Record& level = levels.emplace_back(Record{.threshold_m = o.thresholds_m[t]});
    level.add("AC", accuracy.accuracy_m[t]).add("COM", accuracy.completeness[t]);
  }
  const std::vector<VoxelDistance> voxels = mapeval_wasserstein_distances(*inputs.gaussians);
  const MapEvalEntropy estimate = mapeval_entropy(*inputs.neighborhoods.estimate, o.mme_min_neighbors);
  const MapEvalEntropy reference = mapeval_entropy(*inputs.neighborhoods.reference, kMapEvalReferenceNeighbors);
  Record record;
  record.add("definition", "MapEval 1.0.0 with its initial matrix only").add("per_threshold", std::move(levels));
  record.add("n_correspondences", accuracy.n_correspondences).add("AWD", mean_distance(voxels));
  record.add("SCS", mean_variation(local_variations(voxels, static_cast<int>(o.scs_radius_voxels))));
  record.add("n_voxels", std::uint64_t{voxels.size()});
  Record entropy;
  entropy.add("estimate", estimate.value).add("reference", reference.value);
  entropy.add("valid_estimate", estimate.n_valid).add("valid_reference", reference.n_valid);
  return record.add("MME", std::move(entropy));
}

Record open3d_record(MetricInputs& inputs) {
  std::vector<Record> levels;
  for (const double threshold_m : inputs.options().thresholds_m) {
    const Open3dRegistration r = open3d_registration(distances(inputs, Side::kEstimate), threshold_m);
    Record& level = levels.emplace_back(Record{.threshold_m = threshold_m});
    level.add("fitness", r.fitness).add("inlier_rmse", r.inlier_rmse_m).add("correspondences", r.n_correspondences);
  }
  const auto mean = [&](Side side) { return cloudanalyzer_summary(distances(inputs, side)).mean_m; };
  Record record;
  record.add("definition", "Open3D 0.16 evaluate_registration, compute_point_cloud_distance");
  record.add("per_threshold", std::move(levels));
  return record.add("mean_distance", Record{}
                                         .add("estimate_to_reference", mean(Side::kEstimate))
                                         .add("reference_to_estimate", mean(Side::kReference)));
}

Record cloudcompare_record(MetricInputs& inputs) {
  const CloudCompareDistance d = cloudcompare_distance(distances(inputs, Side::kEstimate));
  Record record;
  record.add("definition", "CloudCompare 2.11 -C2C_DIST, estimate compared with reference");
  return record.add("mean", d.mean_m).add("std", d.standard_deviation_m);
}

double recalled_share(const MapPair& pair) {
  constexpr double kTau = 0.1, kRadius_m = 0.5;
  const auto classes = find_recall(pair, {.tau = kTau, .radius_m = kRadius_m, .radius_steps = 0.0}).classes;
  return static_cast<double>(std::ranges::count(classes, RecallClass::kRecalled)) / static_cast<double>(classes.size());
}

/// At its defaults, whatever ours are.
Record color_map_evaluation_record(MetricInputs& inputs) {
  constexpr double kVoxel_m = 0.1;
  MetricInputs own(MetricOptions{}, *inputs.pair);
  std::vector<Warning> unused;
  const double cd = *measure(catalog::color_distance, own, unused).value;
  const double cf_db = *measure(catalog::color_fidelity, own, unused).value;
  const double lcr = recalled_share(*inputs.pair);
  const ColorConsistency ccs = color_consistency(inputs.estimate, kVoxel_m, 2);
  Record record;
  record.add("definition",
             "Color-Map-Evaluation 0.1.0 at its defaults: tau 0.1, radius 0.5 m, voxels of 0.1 m, singletons zero");
  record.add("CD", cd).add("CD_rgb255", 255.0 * cd);
  if (std::isinf(cf_db)) {
    record.add("CF_dB", "+inf");
  } else {
    record.add("CF_dB", cf_db);
  }
  record.add("LCR", lcr).add("LCR_percent", 100.0 * lcr);
  return record.add("CCS", ccs.trace.value() / ccs.n_occupied.value());
}

Record summary_record(const CloudAnalyzerSummary& s) {
  return Record{}
      .add("mean", s.mean_m)
      .add("median", s.median_m)
      .add("max", s.max_m)
      .add("std", s.standard_deviation_m);
}

Record cloudanalyzer_evaluate(const MetricInputs& inputs) {
  const std::span<const double> estimate = distances(inputs, Side::kEstimate);
  const std::span<const double> reference = distances(inputs, Side::kReference);
  const CloudAnalyzerCurve curve = cloudanalyzer_curve(estimate, reference);
  const CloudAnalyzerSummary forth = cloudanalyzer_summary(estimate), back = cloudanalyzer_summary(reference);
  std::vector<Record> scores;
  for (const CloudAnalyzerScore& s : curve.scores) {
    Record& score = scores.emplace_back();
    score.add("threshold", s.threshold_m).add("precision", s.precision).add("recall", s.recall).add("f1", s.f1);
  }
  Record record;
  record.add("source_points", std::uint64_t{estimate.size()}).add("target_points", std::uint64_t{reference.size()});
  record.add("chamfer_distance", 0.5 * (forth.mean_m + back.mean_m));
  record.add("hausdorff_distance", std::max(forth.max_m, back.max_m));
  record.add("f1_scores", std::move(scores)).add("auc", curve.auc);
  return record.add(
      "distance_stats",
      Record{}.add("source_to_target", summary_record(forth)).add("target_to_source", summary_record(back)));
}

/// Without voxels it prints neither AWD nor SCS.
Record cloudanalyzer_map_evaluate(const MetricInputs& inputs) {
  constexpr double kVoxel_m = 3.0;  // its defaults
  constexpr std::uint64_t kMinPoints = 100;
  constexpr int kRadiusVoxels = 5;
  constexpr std::array kThresholds_m{0.2, 0.1, 0.08, 0.05, 0.01};
  const std::span<const double> forth = distances(inputs, Side::kEstimate), back = distances(inputs, Side::kReference);
  const double mean_forth_m = cloudanalyzer_summary(forth).mean_m, mean_back_m = cloudanalyzer_summary(back).mean_m;
  Record record;
  record.add("n_est", std::uint64_t{forth.size()}).add("n_ref", std::uint64_t{back.size()});
  record.add("mean_est_to_ref_m", mean_forth_m).add("mean_ref_to_est_m", mean_back_m);
  record.add("chamfer_m", mean_forth_m + mean_back_m);
  for (const double t : kThresholds_m) {
    record.add(fmt::format("accuracy@{:.3f}m", t), cloudanalyzer_share_within(forth, t));
    record.add(fmt::format("completeness@{:.3f}m", t), cloudanalyzer_share_within(back, t));
  }
  record.add(
      fmt::format("fscore@{:.3f}m", kThresholds_m[0]),
      f_score(cloudanalyzer_share_within(forth, kThresholds_m[0]), cloudanalyzer_share_within(back, kThresholds_m[0])));
  const CloudAnalyzerStructure structure =
      cloudanalyzer_structure(gaussian_pairs(*inputs.pair, kVoxel_m, kMinPoints), kRadiusVoxels);
  if (std::isfinite(structure.awd_m)) record.add("awd_m", structure.awd_m);
  if (std::isfinite(structure.scs)) record.add("scs", structure.scs);
  return record.add("n_awd_voxels", structure.n_awd_voxels).add("n_scs_voxels", structure.n_scs_voxels);
}

Record cloudanalyzer_record(MetricInputs& inputs) {
  Record record;
  record.add("definition", "CloudAnalyzer 0.6.0 at its defaults: commands evaluate and map-evaluate");
  record.add("evaluate", cloudanalyzer_evaluate(inputs));
  return record.add("map-evaluate", cloudanalyzer_map_evaluate(inputs));
}

MpegCloud mpeg_cloud(const IndexedMap& map) {
  MpegCloud cloud;
  for (std::size_t slot = 0; slot < map.size(); ++slot) {
    cloud.positions.push_back(map.index.points.offset(slot));
    cloud.rgb.push_back(to_rgb8(color_at(map.colors, slot)));
  }
  return cloud;
}

Record mpeg_direction(const MpegDirection& d) {
  Record record;
  record.add("point_mse", d.point_mse_m2).add("hausdorff_squared", d.sq_hausdorff_m2);
  record.add("color_mse", std::vector<double>(d.color_mse.begin(), d.color_mse.end()));
  return record.add("color_psnr", std::vector<double>(d.color_psnr_db.begin(), d.color_psnr_db.end()));
}

Record mpeg_record(MetricInputs& inputs) {
  const MpegDistortion d = mpeg_distortion(mpeg_cloud(inputs.pair->reference), mpeg_cloud(inputs.estimate));
  Record record;
  record.add("definition", "mpeg-pcc-dmetric 0.14 pc_error, point to point and color (BT.709, peak 1)");
  record.add("reference_to_estimate", mpeg_direction(d.reference_to_estimate));
  record.add("estimate_to_reference", mpeg_direction(d.estimate_to_reference));
  return record.add("symmetric", mpeg_direction(d.symmetric));
}

Record tanks_and_temples_record(const MapPair& pair, const EvaluationOptions& o) {
  TanksAndTemplesOptions options;
  options.tau_m = tanks_and_temples_tau_m(o);
  options.crop = o.crop;
  const TanksAndTemplesResult r =
      tanks_and_temples(cloud_of(pair.estimate), cloud_of(pair.reference), Eigen::Matrix4d::Identity(), options);
  Record record;
  record.add("definition", "Tanks and Temples toolbox: three stages of ICP with scale, clouds thinned to tau / 2");
  record.add("tau_m", options.tau_m).add("precision", r.precision).add("recall", r.recall).add("f_score", r.f_score);
  record.add("n_estimate", std::uint64_t{r.n_source}).add("n_reference", std::uint64_t{r.n_target});
  return record.add("scale", r.alignment.scale);
}

/// A tool whose record follows from the metrics' inputs.
struct PeerTool {
  std::string_view name;
  Record (*record)(MetricInputs&);
  const char* without_color;  ///< the warning's id where it needs a color at every point; null: it does not
  const char* needs;
};

constexpr PeerTool kPeerTools[]{
    {"color-map-evaluation", color_map_evaluation_record, "color_map_evaluation_needs_color",
     "Color-Map-Evaluation's numbers need a color at every point of both maps: null"},
    {"cloudanalyzer", cloudanalyzer_record, nullptr, nullptr},
    {"mapeval", mapeval_record, nullptr, nullptr},
    {"open3d", open3d_record, nullptr, nullptr},
    {"cloudcompare", cloudcompare_record, nullptr, nullptr},
    {"mpeg", mpeg_record, "mpeg_needs_color",
     "pc_error's color numbers need a color at every point of both maps: null"}};

std::optional<Record> record_of(const PeerTool& tool, MetricInputs& inputs, std::vector<Warning>& warnings) {
  if (tool.without_color != nullptr && !every_point_has_color(*inputs.pair)) {
    warnings.push_back({tool.without_color, tool.needs});
    return std::nullopt;
  }
  return tool.record(inputs);
}

}  // namespace

std::vector<PeerRecord> peer_records(MetricInputs& inputs, const EvaluationOptions& options,
                                     std::vector<Warning>& warnings) {
  std::vector<PeerRecord> records;
  for (const std::string& name : options.as) {
    const auto tool = std::ranges::find(kPeerTools, name, &PeerTool::name);
    records.push_back({name, tool == std::end(kPeerTools)
                                 ? std::optional(tanks_and_temples_record(*inputs.pair, options))
                                 : record_of(*tool, inputs, warnings)});
  }
  return records;
}

}  // namespace cmap

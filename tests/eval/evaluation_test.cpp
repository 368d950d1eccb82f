#include "cmap/eval/evaluation.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "cmap/core/execution.hpp"
#include "cmap/core/parallel.hpp"
#include "eval/eval_testing.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;
using test::gray_map;
using test::kNone;
using test::options_for;
using test::painted_sheet;
using test::refusal_of;
using test::small_map;
using test::warning_ids;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

/// Values found by hand: distances 0.25 and 3 one way; 0.25, 3 and 5 the other.
const PointCloud kReference =
    small_map({{0, 0, 0}, {8, 0, 0}, {0, 5.25f, 0}}, {Rgb8{0, 0, 0}, Rgb8{0, 255, 0}, Rgb8{0, 0, 0}});
const PointCloud kEstimate = small_map({{0, 0.25f, 0}, {8, 3, 0}}, {Rgb8{0, 0, 0}, Rgb8{0, 0, 0}});

Json fields(const Evaluation& evaluation, std::string_view id) { return test::fields_of(evaluation.metrics, id); }

std::vector<std::string> ids(const Evaluation& evaluation) {
  std::vector<std::string> result;
  for (const MetricRecord& record : evaluation.metrics) result.emplace_back(record.info->id);
  return result;
}

/// Everything that was found, with the options of every kind of metric.
Json everything(const Evaluation& evaluation) {
  Json all = test::fields_of(evaluation.metrics);
  for (const PeerRecord& peer : evaluation.peers) all["aliases"][peer.tool] = test::peer_fields(evaluation, peer.tool);
  all["overlap"] = evaluation.overlap;
  all["rmse_m"] = evaluation.rmse_m;
  for (const Warning& warning : evaluation.warnings) all["warnings"][warning.id] = warning.message;
  return all;
}

EvaluationOptions all_options() {
  EvaluationOptions options = options_for({"all"});
  options.lcr_curve = true;
  options.as = test::tools({"color-map-evaluation", "cloudanalyzer", "mapeval", "open3d", "mpeg", "cloudcompare"});
  options.mme_radius_m = 0.3;
  options.ccs_voxel_m = 0.5;
  return options;
}

TEST(Evaluation, HandComputed) {
  const Evaluation found = evaluate(kReference, kEstimate, EvaluationOptions{});
  EXPECT_EQ(fields(found, "chamfer").at("value"), 3.25 / 2 + 8.25 / 3);
  EXPECT_EQ(fields(found, "overlap").at("value"), 0.5);
  EXPECT_EQ(fields(found, "hausdorff").at("value"), 5.0);
  EXPECT_EQ(fields(found, "local_color_recall").at("value"), 1.0 / 3);
  EXPECT_EQ(fields(found, "color_distance").at("reference_to_estimate"), 1.0 / 3);
  EXPECT_EQ(found.overlap, 0.5);
  EXPECT_EQ(found.rmse_m, std::sqrt(9.0625 / 2));
}

TEST(Evaluation, RecordsAreThoseAskedForInTheCatalogsOrder) {
  EXPECT_THAT(ids(evaluate(kReference, kEstimate, options_for({"rmse", "chamfer"}))), ElementsAre("chamfer", "rmse"));
  EXPECT_THAT(ids(evaluate(kReference, kEstimate, options_for({"mme"}))), ElementsAre("mean_map_entropy"));
  std::vector<std::string> all;
  for (const Metric* metric : metric_list()) all.emplace_back(metric->info.id);
  EXPECT_EQ(ids(evaluate(kReference, kEstimate, options_for({"all"}))), all);
}

TEST(Evaluation, VoxelsTooSmallAreRefusedForWhateverUsesThem) {
  EvaluationOptions options = options_for({"spatial_consistency"});
  options.awd_voxel_m = 1e-9;  // 3e9 along an axis
  EXPECT_THAT(refusal_of<UsageError>([&] { evaluate(kReference, kEstimate, options); }), StartsWith("awd-voxel: "));
  options.metrics = {"chamfer"};
  EXPECT_NO_THROW(evaluate(kReference, kEstimate, options));
  options.as = test::tools({"mapeval"});
  EXPECT_THAT(refusal_of<UsageError>([&] { evaluate(kReference, kEstimate, options); }), StartsWith("awd-voxel: "));
}

TEST(Evaluation, NothingElseIsComputed) {
  const EvaluatedPair found = evaluate(kReference, kEstimate, options_for({"chamfer"}));
  EXPECT_FALSE(found.recall.has_value());
  EXPECT_TRUE(found.peers.empty());
  EXPECT_EQ(warning_ids(found.warnings), kNone) << "no voxel qualifies for AWD, but nobody asked";
  EXPECT_EQ(found.metrics.find("rmse"), nullptr);
  EXPECT_THROW(found.metrics.at("rmse"), std::out_of_range) << "which names what there is";
  EXPECT_TRUE(evaluate(kReference, kEstimate, options_for({"local_color_recall"})).recall.has_value());
}

TEST(Evaluation, EveryStageIsTimedAndReportedInOrder) {
  std::vector<std::string> stages;
  double last = 0.0;
  const Evaluation found = evaluate(kReference, kEstimate, EvaluationOptions{}, Eigen::Matrix4d::Identity(),
                                    {.progress = [&](std::string_view stage, double done) {
                                      stages.emplace_back(stage);
                                      EXPECT_GE(done, last);
                                      EXPECT_LE(done, 1.0);
                                      last = done;
                                    }});
  std::vector<std::string> timed;
  for (const auto& [stage, seconds] : found.stage_seconds) {
    timed.push_back(stage);
    EXPECT_GE(seconds, 0.0);
  }
  EXPECT_EQ(timed, stages);
  EXPECT_THAT(timed, Contains("nearest neighbors"));
}

TEST(Evaluation, OptionsReachTheirMetrics) {
  EvaluationOptions options = options_for({"all"});
  options.thresholds_m = {3.0, 0.25};
  options.overlap_distance_m = 4.0;
  options.lcr_tau = 0.5;
  options.lcr_radius_m = 3.0;
  options.ccs_voxel_m = 16.0;
  options.color_max_distance_m = 1.0;
  const Evaluation found = evaluate(kReference, kEstimate, options);
  const Json fitness = fields(found, "fitness").at("per_threshold");
  ASSERT_EQ(fitness.size(), 2U);
  EXPECT_EQ(fitness[0].at("value"), 1.0) << "thresholds are inclusive";
  EXPECT_EQ(fitness[1].at("value"), 0.5);
  EXPECT_EQ(fields(found, "overlap").at("value"), 1.0);
  EXPECT_EQ(fields(found, "overlap").at("parameters").at("overlap_distance_m"), 4.0);
  EXPECT_EQ(fields(found, "local_color_recall").at("value"), 2.0 / 3) << "3 tau = 1.5: any color within 3 m";
  EXPECT_EQ(fields(found, "local_color_recall").at("parameters"), Json({{"tau", 0.5}, {"radius_m", 3.0}}));
  EXPECT_EQ(fields(found, "color_consistency").at("n_voxels"), 1);
  EXPECT_EQ(fields(found, "color_distance").at("n_unmatched_reference"), 2);
  EXPECT_EQ(found.options.lcr_tau, 0.5);
}

TEST(Evaluation, MapsWithThemselvesArePerfect) {
  const PointCloud map = painted_sheet(3000, 1);
  EvaluationOptions options;
  options.awd_min_points = 20;
  const Evaluation found = evaluate(map, map, options);
  EXPECT_EQ(fields(found, "chamfer").at("value"), 0.0);
  EXPECT_EQ(fields(found, "color_distance").at("value"), 0.0);
  EXPECT_EQ(fields(found, "local_color_recall").at("value"), 1.0);
  EXPECT_EQ(fields(found, "average_wasserstein").at("value"), 0.0);
  const Json f_score = fields(found, "f_score");
  for (const Json& entry : f_score.at("per_threshold")) EXPECT_EQ(entry.at("value"), 1.0);
  EXPECT_TRUE(fields(found, "color_fidelity").at("value").is_null());
  EXPECT_THAT(warning_ids(found.warnings), Contains("color_fidelity_infinite"));
}

TEST(Evaluation, AnExactColorIsWarnedOfOnlyWhereFidelityIsAskedFor) {
  EXPECT_EQ(warning_ids(evaluate(kReference, kReference, options_for({"color_distance"})).warnings), kNone);
}

TEST(Evaluation, MapsWithoutColorGetNullsAndAWarning) {
  const PointCloud bare_reference = small_map({{0, 0, 0}}), bare_estimate = small_map({{0, 0, 1}});
  const std::pair<std::pair<PointCloud, PointCloud>, std::string> cases[] = {
      {{bare_reference, kEstimate}, "the reference has no color"},
      {{kReference, bare_estimate}, "the estimate has no color"},
      {{bare_reference, bare_estimate}, "both maps have no color"}};
  for (const auto& [maps, says] : cases) {
    const EvaluatedPair found = evaluate(maps.first, maps.second, EvaluationOptions{});
    ASSERT_THAT(warning_ids(found.warnings), Contains("no_color"));
    EXPECT_THAT(found.warnings[0].message, HasSubstr(says));
    for (const char* id : {"color_distance", "color_fidelity", "local_color_recall", "color_consistency"}) {
      EXPECT_TRUE(fields(found, id).at("value").is_null()) << id;
    }
    EXPECT_TRUE(fields(found, "chamfer").at("value").is_number());
    EXPECT_FALSE(found.recall.has_value());
  }
}

TEST(Evaluation, ColorThatIsAskedForByNameIsRequired) {
  const PointCloud bare = small_map({{0, 0, 0}});
  for (const char* name : {"color", "color+", "delta_e"}) {
    EXPECT_THAT(refusal_of<UnsupportedError>([&] { evaluate(kReference, bare, options_for({name})); }),
                HasSubstr("the estimate has no color"))
        << name;
  }
  EXPECT_EQ(warning_ids(evaluate(bare, bare, options_for({"geometry"})).warnings), kNone) << "nobody asked for color";
}

TEST(Evaluation, NoOverlapIsAScoreAndAWarning) {
  PointCloud far = kEstimate;
  far.origin = {100, 0, 0};
  const Evaluation found = evaluate(kReference, far, EvaluationOptions{});
  EXPECT_EQ(found.overlap, 0.0);
  EXPECT_EQ(fields(found, "overlap").at("value"), 0.0);
  EXPECT_TRUE(fields(found, "accuracy").at("per_threshold")[0].at("value").is_null());
  EXPECT_THAT(warning_ids(found.warnings), Contains("no_overlap"));
  EXPECT_THAT(warning_ids(found.warnings), Contains("units_or_frame_mismatch"));
  EXPECT_THAT(warning_ids(found.warnings), Not(Contains("precision_reduced")));
}

TEST(Evaluation, MapsAMillionMetersApart) {
  PointCloud far = kReference;
  far.origin = {1e6, 0, 0};
  const Evaluation found = evaluate(kReference, far, EvaluationOptions{});
  EXPECT_THAT(warning_ids(found.warnings), Contains("precision_reduced"));
  // (8, 0, 0) is nearest to all of the far map, whose own nearest is (1e6, 0, 0), its last point 5.25 m aside.
  EXPECT_NEAR(fields(found, "hausdorff").at("value"), 1e6, 1.0);
  EXPECT_NEAR(found.rmse_m, 1e6, 10.0);
  EXPECT_EQ(fields(found, "color_consistency").at("n_singletons"), 3) << "one-cloud metrics are not rounded";
}

TEST(Evaluation, OnePointMaps) {
  const Evaluation found = evaluate(gray_map({{0, 0, 0}}), gray_map({{0, 0, 0.5f}}), options_for({"all"}));
  EXPECT_EQ(fields(found, "chamfer").at("value"), 1.0);
  EXPECT_EQ(fields(found, "local_color_recall").at("value"), 1.0);
  EXPECT_EQ(fields(found, "color_consistency").at("value"), 0.0);
  EXPECT_TRUE(fields(found, "color_consistency").at("exclude").is_null());
  for (const char* id : {"average_wasserstein", "spatial_consistency", "mean_map_entropy"}) {
    EXPECT_TRUE(fields(found, id).at("value").is_null()) << id;
  }
}

TEST(Evaluation, WhatNothingQualifiesForIsNullWithAWarning) {
  EvaluationOptions options = options_for({"color_consistency", "distribution", "mme"});
  options.awd_min_points = options.ccs_min_points = 1000;
  options.ccs_voxel_m = 5.0;
  options.ccs_singletons = Singletons::kExclude;
  const Evaluation found = evaluate(painted_sheet(900, 1), painted_sheet(900, 2), options);
  for (const MetricRecord& metric : found.metrics) EXPECT_TRUE(std::isnan(*metric.record.value)) << metric.info->id;
  EXPECT_THAT(warning_ids(found.warnings), ElementsAre("color_consistency_no_voxels", "average_wasserstein_no_voxels",
                                                       "mean_map_entropy_no_points"));
  EXPECT_THAT(found.warnings[1].message, HasSubstr("no 3 m voxel holds 1000 points of both maps"));
}

TEST(Evaluation, OneQualifyingVoxelHasNoSpatialConsistency) {
  EvaluationOptions options = options_for({"distribution"});
  options.awd_voxel_m = 1000.0;
  PointCloud reference = test::uniform_cloud(500, 1), estimate = test::uniform_cloud(500, 2);
  const Evaluation found = evaluate(reference, estimate, options);
  EXPECT_EQ(fields(found, "average_wasserstein").at("n_voxels"), 1);
  EXPECT_TRUE(fields(found, "spatial_consistency").at("value").is_null());
  EXPECT_THAT(warning_ids(found.warnings), ElementsAre("spatial_consistency_no_voxels"));
}

TEST(Evaluation, TheTransformIsRecorded) {
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T(1, 3) = -0.25;
  const Evaluation found = evaluate(kReference, kEstimate, options_for({"geometry"}), T);
  EXPECT_EQ(found.T_ref_est, T);
  EXPECT_EQ(fields(found, "chamfer").at("estimate_to_reference"), 2.75 / 2) << "(0, 0, 0) and (8, 2.75, 0)";
}

TEST(Evaluation, CropAndThinningAreWhatIsCompared) {
  EvaluationOptions options = options_for({"geometry"});
  options.crop = Box3d{{-1, -1, -1}, {9, 4, 1}};
  options.voxel_m = 100.0;
  const EvaluatedPair found = evaluate(kReference, kEstimate, options);
  EXPECT_EQ(found.pair.reference.size(), 1U);
  EXPECT_EQ(fields(found, "chamfer").at("value"), 2 * std::hypot(0.0, 1.625)) << "(4, 0, 0) and (4, 1.625, 0)";
}

TEST(Evaluation, OtherToolsAreAddedByName) {
  EvaluationOptions options = options_for({"chamfer"});
  options.as = test::tools({"cloudcompare", "mpeg"});
  const Evaluation found = evaluate(kReference, kEstimate, options);
  EXPECT_EQ(found.peers.size(), 2U);
  EXPECT_EQ(test::peer_fields(found, "cloudcompare").at("mean"), 1.625);
  EXPECT_TRUE(test::peer_fields(found, "mpeg").at("symmetric").is_object());
  const Evaluation bare = evaluate(small_map({{0, 0, 0}}), kEstimate, options);
  EXPECT_TRUE(test::peer_fields(bare, "mpeg").is_null());
  EXPECT_THAT(warning_ids(bare.warnings), Contains("mpeg_needs_color"));
}

/// Two voxels of trace 0.02, as in the example of the authors' tool, and a lone point.
const std::vector<Eigen::Vector3f> kSpots{{0.01f, 0, 0}, {0.02f, 0, 0}, {1.01f, 0, 0}, {1.02f, 0, 0}, {5, 5, 5}};
const std::vector<Rgb8> kSpotColors{{0, 0, 0}, {51, 0, 0}, {0, 102, 0}, {0, 153, 0}, {9, 9, 9}};
const PointCloud kSpotMap = small_map(kSpots, kSpotColors);

TEST(Evaluation, ConsistencyHasItsValueUnderBothRules) {
  EvaluationOptions options = options_for({"CCS"});
  const std::tuple<Singletons, double, int> cases[] = {{Singletons::kZero, 0.02 * 2 / 3, 3},
                                                       {Singletons::kExclude, 0.02, 2}};
  for (const auto& [singletons, value, n] : cases) {
    options.ccs_singletons = singletons;
    const Evaluation found = evaluate(kSpotMap, kSpotMap, options);
    const Json record = fields(found, "color_consistency");
    for (const Json& numbers : {record, record.at("reference")}) {
      EXPECT_DOUBLE_EQ(numbers.at("value").get<double>(), value);
      EXPECT_DOUBLE_EQ(numbers.at("value_x100").get<double>(), 100 * value);
      EXPECT_DOUBLE_EQ(numbers.at("zero").get<double>(), 0.02 * 2 / 3);
      EXPECT_DOUBLE_EQ(numbers.at("exclude").get<double>(), 0.02);
      EXPECT_DOUBLE_EQ(numbers.at("median").get<double>(), 0.02);
      EXPECT_EQ(numbers.at("n_voxels"), n);
      EXPECT_EQ(numbers.at("n_occupied"), 3);
      EXPECT_EQ(numbers.at("n_singletons"), 1);
    }
    EXPECT_EQ(record.at("parameters"),
              Json({{"voxel_m", 0.1}, {"singletons", name_of(singletons, singletons_names())}, {"min_points", 2}}));
    EXPECT_EQ(warning_ids(found.warnings), kNone) << "a third of single points is no more than half";
  }
}

TEST(Evaluation, SingletonsCanBeRefused) {
  EvaluationOptions options = options_for({"CCS"});
  options.ccs_singletons = Singletons::kRefuse;
  EXPECT_THAT(refusal_of<UnsupportedError>([&] { evaluate(kSpotMap, kSpotMap, options); }),
              HasSubstr("ccs-singletons: 1 of the evaluated map's 3 voxels of 0.1 m hold a single point"));
  const PointCloud whole = small_map({kSpots.begin(), kSpots.end() - 1}, {kSpotColors.begin(), kSpotColors.end() - 1});
  const Evaluation found = evaluate(kSpotMap, whole, options);
  EXPECT_DOUBLE_EQ(fields(found, "color_consistency").at("value").get<double>(), 0.02);
}

TEST(Evaluation, AMapOfOnePointAVoxelIsWarnedOf) {
  const std::vector<Eigen::Vector3f> apart{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {3.01f, 0, 0}};
  const PointCloud map = gray_map(apart);
  const Evaluation found = evaluate(map, map, options_for({"CCS"}));
  ASSERT_THAT(warning_ids(found.warnings), ElementsAre("color_consistency_sparse"));
  EXPECT_THAT(found.warnings[0].message, HasSubstr("3 of the evaluated map's 4 voxels of 0.1 m"));
  // The same points three times each.
  std::vector<Eigen::Vector3f> copies = apart;
  for (int copy = 1; copy < 3; ++copy) copies.insert(copies.end(), apart.begin(), apart.end());
  const Evaluation copied = evaluate(map, gray_map(copies), options_for({"CCS"}));
  EXPECT_EQ(fields(copied, "color_consistency").at("n_singletons"), 0);
  ASSERT_THAT(warning_ids(copied.warnings), ElementsAre("color_consistency_sparse"));
  EXPECT_THAT(copied.warnings[0].message, HasSubstr("3 of the evaluated map's 4 voxels of 0.1 m"));
}

/// Voxel centers a tenth of a meter apart, as typed; every option that is a threshold at a tenth.
TEST(Evaluation, ThresholdsMeanWhatWasTyped) {
  PointCloud reference, estimate;
  for (int i = 0; i < 12; ++i) {
    reference.positions.push_back(Eigen::Vector3d(i, 3.0, 0.1).cast<float>());
    estimate.positions.push_back(Eigen::Vector3d(i, 3.0, 0.2).cast<float>());
  }
  reference.colors = estimate.colors = Array<Rgb8>(12, Rgb8{1, 2, 3});
  EvaluationOptions options = options_for({"all"});
  options.thresholds_m = {0.1, 0.099};
  options.overlap_distance_m = options.lcr_radius_m = 0.1;
  options.color_max_distance_m = 0.1;
  options.bootstrap = 5;
  options.as = test::tools({"open3d", "cloudanalyzer"});
  const Evaluation found = evaluate(reference, estimate, options);
  const Json intervals = intervals_json(*found.intervals);
  for (const char* id : {"fitness", "completeness", "f_score"}) {
    const Json record = fields(found, id);
    EXPECT_EQ(record.at("per_threshold")[0].at("value"), 1.0) << id;
    EXPECT_EQ(record.at("per_threshold")[1].at("value"), 0.0) << id;
    EXPECT_EQ(intervals.at("metrics").at(id).at("per_threshold")[0].at("lower"), 1.0) << id;
  }
  EXPECT_NEAR(fields(found, "accuracy").at("per_threshold")[0].at("value").get<double>(), 0.1, 1e-8);
  EXPECT_EQ(found.overlap, 1.0);
  EXPECT_EQ(fields(found, "local_color_recall").at("value"), 1.0);
  EXPECT_EQ(fields(found, "color_distance").at("n_unmatched_estimate"), 0);
  EXPECT_EQ(fields(found, "delta_e").at("estimate_to_reference").at("n"), 12);
  EXPECT_EQ(fields(found, "color_distance_exposure_free").at("n_pairs"), 12);
  EXPECT_EQ(test::peer_fields(found, "open3d").at("per_threshold")[0].at("fitness"), 0.0)
      << "other tools compare as they do";
  EXPECT_EQ(test::peer_fields(found, "cloudanalyzer").at("map-evaluate").at("accuracy@0.100m"), 0.0);
}

/// One of two estimated points and one of three reference points have no color: by hand.
TEST(Evaluation, PointsWithoutColorCountForGeometryOnly) {
  const RgbF none{NAN, NAN, NAN};
  PointCloud reference = small_map({{0, 0.25f, 0}, {1, 0.25f, 0}, {2, 0.25f, 0}});
  PointCloud estimate = small_map({{0, 0, 0}, {1, 0, 0}});
  reference.colors = Array<RgbF>{{0.25f, 0, 0}, {1, 1, 1}, none};
  estimate.colors = Array<RgbF>{{0, 0, 0}, none};
  EvaluationOptions options = options_for({"all"});
  options.bootstrap = 5;
  options.as = test::tools({"mpeg", "color-map-evaluation", "cloudanalyzer"});
  const Evaluation found = evaluate(reference, estimate, options);
  EXPECT_EQ(fields(found, "chamfer").at("n_reference"), 3);
  const Json cd = fields(found, "color_distance");
  EXPECT_EQ(cd.at("value"), 0.25);
  EXPECT_EQ(cd.at("n_estimate"), 1);
  EXPECT_EQ(cd.at("n_unmatched_reference"), 2);
  EXPECT_EQ(cd.at("n_without_color_estimate"), 1);
  EXPECT_EQ(cd.at("n_without_color_reference"), 1);
  const Json lcr = fields(found, "local_color_recall");
  EXPECT_EQ(lcr.at("n_reference"), 2);
  EXPECT_EQ(lcr.at("coverage"), 1.0) << "what covers needs no color";
  EXPECT_EQ(lcr.at("value"), 0.5);
  EXPECT_EQ(fields(found, "color_consistency").at("n_occupied"), 1);
  EXPECT_EQ(fields(found, "color_consistency").at("n_without_color"), 1);
  EXPECT_EQ(fields(found, "color_consistency").at("reference").at("n_occupied"), 2);
  EXPECT_EQ(fields(found, "delta_e").at("reference_to_estimate").at("n"), 1);
  EXPECT_NEAR(fields(found, "color_psnr").at("value").get<double>(), -20 * std::log10(0.2126 * 0.25), 1e-12);
  EXPECT_EQ(fields(found, "color_distance_by_range").at("per_range")[3].at("n_reference"), 1);
  EXPECT_TRUE(test::peer_fields(found, "mpeg").is_null());
  EXPECT_TRUE(test::peer_fields(found, "color-map-evaluation").is_null());
  EXPECT_TRUE(test::peer_fields(found, "cloudanalyzer").is_object());
  const auto& sums = found.intervals->blocks.sums.columns;
  EXPECT_EQ(sums.at("local_color_recall.reference.colored"), std::vector<double>{2.0});
  EXPECT_EQ(sums.at("color_psnr.estimate.n"), std::vector<double>{1.0});
}

TEST(Evaluation, ColorsThatNoPointHasAreNone) {
  PointCloud bare = small_map({{0, 0, 0}, {1, 0, 0}});
  bare.colors = Array<RgbF>(2, RgbF{NAN, NAN, NAN});
  const Evaluation found = evaluate(kReference, bare, EvaluationOptions{});
  EXPECT_THAT(warning_ids(found.warnings), Contains("no_color"));
  EXPECT_TRUE(fields(found, "color_distance").at("value").is_null());
  EXPECT_THROW(evaluate(kReference, bare, options_for({"color"})), UnsupportedError);
}

TEST(Evaluation, AFlatMapHasNoEntropyAndSaysWhy) {
  PointCloud plane;
  for (int i = 0; i < 100; ++i) {
    plane.positions.push_back({0.1f * static_cast<float>(i % 10), 0.1f * static_cast<float>(i / 10), 1});
  }
  EvaluationOptions options = options_for({"mme"});
  options.mme_radius_m = 0.35;
  const Evaluation found = evaluate(plane, plane, options);
  EXPECT_TRUE(fields(found, "mean_map_entropy").at("value").is_null());
  EXPECT_EQ(fields(found, "mean_map_entropy").at("n_flat"), 100);
  ASSERT_THAT(warning_ids(found.warnings), ElementsAre("mean_map_entropy_flat"));
  EXPECT_THAT(found.warnings[0].message, HasSubstr("flat to the rounding"));
}

/// Another tool's record is made at its own defaults, whatever the options say.
TEST(Evaluation, TheAuthorsToolAtItsDefaults) {
  const PointCloud four = small_map({kSpots.begin(), kSpots.end() - 1}, {kSpotColors.begin(), kSpotColors.end() - 1});
  std::vector<Eigen::Vector3f> places(kSpots.begin(), kSpots.end() - 1);
  std::vector<Rgb8> colors(kSpotColors.begin(), kSpotColors.end() - 1);
  places.push_back({10, 0, 0});
  colors.push_back({0, 0, 255});
  EvaluationOptions options = options_for({"chamfer"});
  options.as = test::tools({"color-map-evaluation"});
  options.lcr_tau = 9.0;
  options.lcr_radius_m = 99.0;
  options.ccs_voxel_m = 7.0;
  options.color_max_distance_m = 0.5;
  const Evaluation found = evaluate(small_map(places, colors), four, options);
  const Json record = test::peer_fields(found, "color-map-evaluation");
  EXPECT_NEAR(record.at("CD").get<double>(), std::sqrt(1.36) / 10, 1e-15);
  EXPECT_NEAR(record.at("CD_rgb255").get<double>(), 25.5 * std::sqrt(1.36), 1e-12);
  EXPECT_NEAR(record.at("CF_dB").get<double>(), 18.66, 0.005);
  EXPECT_EQ(record.at("LCR"), 0.8);
  EXPECT_EQ(record.at("LCR_percent"), 80.0);
  EXPECT_NEAR(record.at("CCS").get<double>(), 0.02, 1e-15);
  EXPECT_EQ(test::peer_fields(evaluate(four, four, options), "color-map-evaluation").at("CF_dB"), "+inf");
}

/// Distances 0.25 and 3 one way; 0.25, 3 and 5 the other. Only the thresholds 0.3, 0.5 and 1 m see any: P 1/2, R 1/3.
TEST(Evaluation, CloudAnalyzerAtItsDefaults) {
  EvaluationOptions options = options_for({"chamfer"});
  options.as = test::tools({"cloudanalyzer"});
  options.thresholds_m = {7.0};
  const Evaluation evaluation = evaluate(kReference, kEstimate, options);
  const Json found = test::peer_fields(evaluation, "cloudanalyzer");
  const Json one = found.at("evaluate"), two = found.at("map-evaluate");
  EXPECT_DOUBLE_EQ(one.at("chamfer_distance").get<double>(), (3.25 / 2 + 8.25 / 3) / 2);
  EXPECT_DOUBLE_EQ(two.at("chamfer_m").get<double>(), 3.25 / 2 + 8.25 / 3);
  EXPECT_EQ(one.at("hausdorff_distance"), 5.0);
  EXPECT_EQ(one.at("f1_scores")[2].at("f1"), 0.0);
  EXPECT_DOUBLE_EQ(one.at("f1_scores")[3].at("f1").get<double>(), 0.4);
  EXPECT_DOUBLE_EQ(one.at("auc").get<double>(), (0.1 * 0.2 + 0.7 * 0.4) / 0.95);
  const Json back = one.at("distance_stats").at("target_to_source");
  EXPECT_DOUBLE_EQ(back.at("median").get<double>(), 3.0);
  EXPECT_DOUBLE_EQ(back.at("std").get<double>(), std::sqrt((0.0625 + 9 + 25) / 3 - 2.75 * 2.75));
  EXPECT_EQ(two.at("accuracy@0.200m"), 0.0);
  EXPECT_EQ(two.at("fscore@0.200m"), 0.0);
  EXPECT_EQ(two.at("n_awd_voxels"), 0);
  EXPECT_FALSE(two.contains("awd_m"));
}

TEST(Evaluation, BrokenMapsAreInputErrors) {
  EXPECT_THAT(refusal_of<InputError>([] { evaluate({}, kEstimate, EvaluationOptions{}); }),
              HasSubstr("the reference has no points"));
  EXPECT_THAT(refusal_of<InputError>([] {
                evaluate(kReference, gray_map({{NAN, 0, 0}}), EvaluationOptions{});
              }),
              HasSubstr("the estimate has a point that is not finite"));
}

TEST(Evaluation, VoxelsTooSmallForTheMapAreRefused) {
  for (double MetricOptions::*voxel : {&MetricOptions::ccs_voxel_m, &MetricOptions::awd_voxel_m}) {
    EvaluationOptions options;
    options.*voxel = 1e-10;
    EXPECT_THAT(refusal_of<UsageError>([&] { evaluate(kReference, kEstimate, options); }), HasSubstr("voxel"));
  }
  EvaluationOptions thinned;
  thinned.voxel_m = 1e-10;
  EXPECT_THAT(refusal_of<UsageError>([&] { evaluate(kReference, kEstimate, thinned); }), HasSubstr("voxel"));
}

TEST(Evaluation, IsBitwiseTheSameForAnyNumberOfThreads) {
  // More than one chunk of every parallel loop.
  const PointCloud reference = painted_sheet(kLoopChunk + 5000, 1), estimate = painted_sheet(kLoopChunk + 1000, 2);
  std::vector<std::string> found;
  for (int threads : {1, 2, 3, 8}) {
    const ExecutionScope limit({.threads = threads});
    found.push_back(everything(evaluate(reference, estimate, all_options())).dump());
  }
  for (const std::string& other : found) EXPECT_EQ(other, found.front());
}

PointCloud reversed(const PointCloud& map) {
  PointCloud result = map;
  std::ranges::reverse(result.positions);
  std::ranges::reverse(std::get<Array<Rgb8>>(result.colors));
  return result;
}

/// The same structure, and numbers that differ by their summation at most.
void expect_equal_numbers(const Json& a, const Json& b, const std::string& place) {
  ASSERT_EQ(a.type(), b.type()) << place;
  if (a.is_number_float()) {
    EXPECT_NEAR(a.get<double>(), b.get<double>(), 1e-11 * std::abs(a.get<double>())) << place;
  } else if (a.is_structured()) {
    ASSERT_EQ(a.size(), b.size()) << place;
    for (auto x = a.items().begin(), y = b.items().begin(); x != a.items().end(); ++x, ++y) {
      expect_equal_numbers(x.value(), y.value(), place + "/" + x.key());
    }
  } else {
    EXPECT_EQ(a, b) << place;
  }
}

TEST(Evaluation, TheOrderOfThePointsDoesNotMatter) {
  const PointCloud reference = painted_sheet(5000, 1), estimate = painted_sheet(4000, 2);
  expect_equal_numbers(everything(evaluate(reference, estimate, all_options())),
                       everything(evaluate(reversed(reference), reversed(estimate), all_options())), "");
}

TEST(Evaluation, FlannFindsTheSame) {
  const PointCloud reference = painted_sheet(5000, 1), estimate = painted_sheet(4000, 2);
  EvaluationOptions flann = all_options();
  flann.index = IndexKind::kFlann;
  expect_equal_numbers(everything(evaluate(reference, estimate, all_options())),
                       everything(evaluate(reference, estimate, flann)), "");
}

TEST(Evaluation, NoRecordHoldsANumberThatIsNotFinite) {
  // JSON has no NaN: nlohmann writes null for it, and a reader of the library would see it.
  const std::function<void(const Json&, const std::string&)> check = [&](const Json& value, const std::string& place) {
    if (value.is_number_float()) {
      EXPECT_TRUE(std::isfinite(value.get<double>())) << place;
    } else if (value.is_structured()) {
      for (const auto& [key, item] : value.items()) check(item, place + "/" + key);
    }
  };
  PointCloud far = kEstimate;
  far.origin = {100, 0, 0};
  for (const PointCloud& estimate : {kEstimate, kReference, far, gray_map({{0, 0, 0}})}) {
    check(everything(evaluate(kReference, estimate, all_options())), "");
  }
}

}  // namespace
}  // namespace cmap

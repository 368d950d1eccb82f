#include "cmap/eval/evaluation.hpp"

#include <cmath>

#include "eval/hand_maps.hpp"

namespace cmap {
namespace evaluation_test {

using Json = nlohmann::ordered_json;
using test::gray_map;
using test::kEstimate;
using test::kNone;
using test::kReference;
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

Json fields(const Evaluation& evaluation, std::string_view id) { return test::fields_of(evaluation.metrics, id); }

std::vector<std::string> ids(const Evaluation& evaluation) {
  std::vector<std::string> result;
  for (const MetricRecord& record : evaluation.metrics) result.emplace_back(record.info->id);
  return result;
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

}  // namespace evaluation_test
}  // namespace cmap

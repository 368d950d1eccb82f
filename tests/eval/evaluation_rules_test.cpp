#include <cmath>

#include "cmap/eval/evaluation.hpp"
#include "eval/hand_maps.hpp"

namespace cmap {
namespace evaluation_rules_test {

using Json = nlohmann::ordered_json;
using test::gray_map;
using test::kNone;
using test::kReference;
using test::kSpotColors;
using test::kSpotMap;
using test::kSpots;
using test::options_for;
using test::refusal_of;
using test::small_map;
using test::warning_ids;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

Json fields(const Evaluation& evaluation, std::string_view id) { return test::fields_of(evaluation.metrics, id); }

TEST(EvaluationRules, ConsistencyHasItsValueUnderBothRules) {
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

TEST(EvaluationRules, SingletonsCanBeRefused) {
  EvaluationOptions options = options_for({"CCS"});
  options.ccs_singletons = Singletons::kRefuse;
  EXPECT_THAT(refusal_of<UnsupportedError>([&] { evaluate(kSpotMap, kSpotMap, options); }),
              HasSubstr("ccs-singletons: 1 of the evaluated map's 3 voxels of 0.1 m hold a single point"));
  const PointCloud whole = small_map({kSpots.begin(), kSpots.end() - 1}, {kSpotColors.begin(), kSpotColors.end() - 1});
  const Evaluation found = evaluate(kSpotMap, whole, options);
  EXPECT_DOUBLE_EQ(fields(found, "color_consistency").at("value").get<double>(), 0.02);
}

TEST(EvaluationRules, AMapOfOnePointAVoxelIsWarnedOf) {
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
TEST(EvaluationRules, ThresholdsMeanWhatWasTyped) {
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
TEST(EvaluationRules, PointsWithoutColorCountForGeometryOnly) {
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

TEST(EvaluationRules, ColorsThatNoPointHasAreNone) {
  PointCloud bare = small_map({{0, 0, 0}, {1, 0, 0}});
  bare.colors = Array<RgbF>(2, RgbF{NAN, NAN, NAN});
  const Evaluation found = evaluate(kReference, bare, EvaluationOptions{});
  EXPECT_THAT(warning_ids(found.warnings), Contains("no_color"));
  EXPECT_TRUE(fields(found, "color_distance").at("value").is_null());
  EXPECT_THROW(evaluate(kReference, bare, options_for({"color"})), UnsupportedError);
}

TEST(EvaluationRules, AFlatMapHasNoEntropyAndSaysWhy) {
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

}  // namespace evaluation_rules_test
}  // namespace cmap

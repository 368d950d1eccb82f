#include <cmath>

#include "cmap/eval/evaluation.hpp"
#include "eval/hand_maps.hpp"

namespace cmap {
namespace other_tools_test {

using Json = nlohmann::ordered_json;
using test::kEstimate;
using test::kReference;
using test::kSpotColors;
using test::kSpots;
using test::options_for;
using test::small_map;
using test::warning_ids;
using ::testing::Contains;

TEST(OtherTools, OtherToolsAreAddedByName) {
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

/// Another tool's record is made at its own defaults, whatever the options say.
TEST(OtherTools, TheAuthorsToolAtItsDefaults) {
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
TEST(OtherTools, CloudAnalyzerAtItsDefaults) {
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

}  // namespace other_tools_test
}  // namespace cmap

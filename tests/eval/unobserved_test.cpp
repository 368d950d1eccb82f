#include <nlohmann/json.hpp>

#include "eval/eval_testing.hpp"

namespace cmap {
namespace unobserved_test {

using test::gray_map;
using test::options_for;

EvaluationOptions observing(std::vector<std::string> metrics) {
  EvaluationOptions options = options_for(std::move(metrics));
  options.observed = Observed::kAuto;
  return options;
}

nlohmann::ordered_json unobserved_of(const Evaluation& evaluation) {
  return observed_json(*evaluation.unobserved, evaluation.options);
}

/// Columns of 1 m, grown by one: a point at 0.5 is seen from those at -1 .. 2, but not beyond.
TEST(Unobserved, HandComputed) {
  const PointCloud reference = gray_map({{0.5f, 0.5f, 0}, {10.5f, 0.5f, 0}});
  const PointCloud estimate = gray_map({{0.5f, 0.5f, 0.25f}, {1.5f, 1.5f, 7}, {2.5f, 0.5f, 0}});
  const Evaluation found = evaluate(reference, estimate, observing({"chamfer", "fitness", "hausdorff"}));
  const auto unobserved = unobserved_of(found);
  EXPECT_EQ(unobserved.at("estimate").at("n_unobserved"), 1) << "the one at 2.5";
  EXPECT_EQ(unobserved.at("estimate").at("share_unobserved"), 1.0 / 3);
  EXPECT_EQ(unobserved.at("reference").at("n_unobserved"), 1) << "the one at 10.5";
  // Observed: estimated points 0.25 and sqrt(51) from the reference, the reference point 0.25 from the estimate.
  EXPECT_DOUBLE_EQ(unobserved.at("metrics").at("chamfer").at("value").get<double>(),
                   0.5 * (0.25 + std::sqrt(51.0)) + 0.25);
  EXPECT_EQ(unobserved.at("metrics").at("fitness").at("per_threshold")[0].at("value"), 0.0);
  EXPECT_FALSE(unobserved.at("metrics").contains("hausdorff"));
  EXPECT_EQ(found.metrics.at("chamfer").number("n_estimate"), 3) << "the plain numbers stay as they are";
}

TEST(Unobserved, HeightDoesNotMatter) {
  const PointCloud reference = gray_map({{0.5f, 0.5f, 0}});
  const PointCloud estimate = gray_map({{0.5f, 0.5f, 500}});
  const Evaluation found = evaluate(reference, estimate, observing({"chamfer"}));
  EXPECT_EQ(unobserved_of(found).at("estimate").at("n_unobserved"), 0);
}

TEST(Unobserved, MapsApartLeaveNothing) {
  const Evaluation found =
      evaluate(gray_map({{0, 0, 0}}), gray_map({{2e4f, 0, 0}}), observing({"chamfer", "color_distance"}));
  EXPECT_EQ(unobserved_of(found).at("estimate").at("share_unobserved"), 1.0);
  EXPECT_TRUE(unobserved_of(found).at("metrics").at("chamfer").at("value").is_null());
}

TEST(Unobserved, OfEqualMapsIsNothing) {
  const PointCloud map = test::painted_sheet(2000, 3);
  const Evaluation found = evaluate(map, map, observing({"default"}));
  EXPECT_EQ(unobserved_of(found).at("estimate").at("n_unobserved"), 0);
  EXPECT_EQ(unobserved_of(found).at("metrics").at("local_color_recall").at("value"), 1.0);
  EXPECT_EQ(unobserved_of(found).at("metrics").at("chamfer").at("value"), 0.0);
}

/// A wall between the sensor and one of three reference points: that one is not the estimate's fault.
TEST(Unobserved, WhatASensorCouldNotSee) {
  PointCloud reference;
  for (float y = -5; y <= 5; y += 0.1f) {
    for (float z = 0.05f; z <= 5; z += 0.1f) reference.positions.push_back({5.05f, y, z});
  }
  const std::size_t n_wall = reference.size();
  reference.positions.push_back({2.05f, 4.95f, 1.05f});
  reference.positions.push_back({12.05f, 0.05f, 1.05f});  // behind the wall
  const PointCloud estimate = gray_map({{2.05f, 4.95f, 1.3f}});
  EvaluationOptions options = observing({"chamfer", "completeness"});
  options.observed = Observed::kSensor;
  const std::vector<Eigen::Vector3d> sensor{{-3, 0, 1}};
  const auto unobserved =
      unobserved_of(evaluate(reference, estimate, options, Eigen::Matrix4d::Identity(), {}, sensor));
  EXPECT_EQ(unobserved.at("method"), "sensor");
  EXPECT_EQ(unobserved.at("reference").at("n_unobserved"), 1);
  EXPECT_EQ(unobserved.at("estimate").at("n_unobserved"), 0);
  options.thresholds_m = {0.5};
  const auto within = unobserved_of(evaluate(reference, estimate, options, Eigen::Matrix4d::Identity(), {}, sensor));
  EXPECT_DOUBLE_EQ(within.at("metrics").at("completeness").at("per_threshold")[0].at("value").get<double>(),
                   1.0 / static_cast<double>(n_wall + 1));
}

TEST(Unobserved, ASensorNeedsPositions) {
  EvaluationOptions options = observing({"chamfer"});
  options.observed = Observed::kSensor;
  EXPECT_NE(test::refusal_of<UsageError>([&] { evaluate(gray_map({{0, 0, 0}}), gray_map({{0, 0, 0}}), options); }), "");
}

}  // namespace unobserved_test
}  // namespace cmap

#include <nlohmann/json.hpp>

#include "eval/eval_testing.hpp"

namespace cmap {
namespace {

using test::gray_map;
using test::options_for;

EvaluationOptions observing(std::vector<std::string> metrics) {
  EvaluationOptions options = options_for(std::move(metrics));
  options.observed = Observed::kAuto;
  return options;
}

/// Columns of 1 m, grown by one: a point at 0.5 is seen from those at -1 .. 2, but not beyond.
TEST(Unobserved, HandComputed) {
  const PointCloud reference = gray_map({{0.5f, 0.5f, 0}, {10.5f, 0.5f, 0}});
  const PointCloud estimate = gray_map({{0.5f, 0.5f, 0.25f}, {1.5f, 1.5f, 7}, {2.5f, 0.5f, 0}});
  const Evaluation found = evaluate(reference, estimate, observing({"chamfer", "fitness", "hausdorff"}));
  const auto& unobserved = found.unobserved;
  EXPECT_EQ(unobserved.at("estimate").at("n_unobserved"), 1) << "the one at 2.5";
  EXPECT_EQ(unobserved.at("estimate").at("share_unobserved"), 1.0 / 3);
  EXPECT_EQ(unobserved.at("reference").at("n_unobserved"), 1) << "the one at 10.5";
  // Observed: estimated points 0.25 and sqrt(51) from the reference, the reference point 0.25 from the estimate.
  EXPECT_DOUBLE_EQ(unobserved.at("metrics").at("chamfer").at("value").get<double>(),
                   0.5 * (0.25 + std::sqrt(51.0)) + 0.25);
  EXPECT_EQ(unobserved.at("metrics").at("fitness").at("per_threshold")[0].at("value"), 0.0);
  EXPECT_FALSE(unobserved.at("metrics").contains("hausdorff"));
  EXPECT_EQ(found.find("chamfer")->fields.at("n_estimate"), 3) << "the plain numbers stay as they are";
}

TEST(Unobserved, HeightDoesNotMatter) {
  const PointCloud reference = gray_map({{0.5f, 0.5f, 0}});
  const PointCloud estimate = gray_map({{0.5f, 0.5f, 500}});
  const Evaluation found = evaluate(reference, estimate, observing({"chamfer"}));
  EXPECT_EQ(found.unobserved.at("estimate").at("n_unobserved"), 0);
}

TEST(Unobserved, MapsApartLeaveNothing) {
  const Evaluation found =
      evaluate(gray_map({{0, 0, 0}}), gray_map({{2e4f, 0, 0}}), observing({"chamfer", "color_distance"}));
  EXPECT_EQ(found.unobserved.at("estimate").at("share_unobserved"), 1.0);
  EXPECT_TRUE(found.unobserved.at("metrics").at("chamfer").at("value").is_null());
}

TEST(Unobserved, OfEqualMapsIsNothing) {
  const PointCloud map = test::painted_sheet(2000, 3);
  const Evaluation found = evaluate(map, map, observing({"default"}));
  EXPECT_EQ(found.unobserved.at("estimate").at("n_unobserved"), 0);
  EXPECT_EQ(found.unobserved.at("metrics").at("local_color_recall").at("value"), 1.0);
  EXPECT_EQ(found.unobserved.at("metrics").at("chamfer").at("value"), 0.0);
}

}  // namespace
}  // namespace cmap

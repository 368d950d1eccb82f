#include "cmap/eval/map_evaluation.hpp"

#include <algorithm>

#include "cmap/core/execution.hpp"
#include "eval/eval_testing.hpp"

namespace cmap {
namespace map_evaluation_test {

using test::fields_of;
using test::kNone;
using test::options_for;
using test::painted_sheet;
using test::refusal_of;
using test::small_map;
using test::warning_ids;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Json = nlohmann::ordered_json;

std::vector<std::string> ids_of(const MapEvaluation& evaluation) {
  std::vector<std::string> ids;
  for (const MetricRecord& record : evaluation.metrics) ids.emplace_back(record.info->id);
  return ids;
}

TEST(EvaluateMap, GivesWhatNeedsNoReference) {
  const MapEvaluation found = evaluate_map(painted_sheet(3000, 1), {});
  EXPECT_THAT(ids_of(found), ElementsAre("color_consistency", "mean_map_entropy", "point_spacing"));
}

/// Two voxels of 0.5 m, of two points each; gray levels 0, 51 and 0, 102 of 255.
TEST(EvaluateMap, ByHand) {
  EvaluationOptions options = options_for({"color", "density"});
  options.ccs_voxel_m = 0.5;
  const MapEvaluation found =
      evaluate_map(small_map({{0.1f, 0, 0}, {0.2f, 0, 0}, {2.1f, 0, 0}, {2.4f, 0, 0}},
                             {Rgb8{0, 0, 0}, Rgb8{51, 51, 51}, Rgb8{0, 0, 0}, Rgb8{102, 102, 102}}),
                   options);
  // Trace of the covariance of two grays: 3 d^2 / 2, d = 0.2 and 0.4.
  EXPECT_NEAR(fields_of(found.metrics, "color_consistency").at("value").get<double>(), (0.06 + 0.24) / 2, 1e-12);
  const Json spacing = fields_of(found.metrics, "point_spacing");
  EXPECT_NEAR(spacing.at("value").get<double>(), 0.2, 1e-6);  // 0.1, 0.1, 0.3, 0.3
  EXPECT_NEAR(spacing.at("mean").get<double>(), 0.2, 1e-6);
  EXPECT_EQ(spacing.at("n"), 4);
  EXPECT_EQ(warning_ids(found.warnings), kNone);
}

TEST(EvaluateMap, AgreesWithThePair) {
  EvaluationOptions options = options_for({"color", "mme", "density"});
  options.mme_radius_m = 0.5;
  const PointCloud map = painted_sheet(3000, 1), other = painted_sheet(2000, 2);
  const MapEvaluation alone = evaluate_map(map, options);
  const Evaluation as_estimate = evaluate(other, map, options), as_reference = evaluate(map, other, options);
  for (const char* id : {"color_consistency", "mean_map_entropy", "point_spacing"}) {
    Json fields = fields_of(alone.metrics, id), of_pair = fields_of(as_estimate.metrics, id);
    for (const char* of_pairs : {"reference", "floor", "chance"}) of_pair.erase(of_pairs);
    EXPECT_EQ(fields, of_pair) << id;
    fields.erase("parameters");
    EXPECT_EQ(fields, fields_of(as_reference.metrics, id).at("reference")) << id;
  }
}

/// A tilted plane in steps of 1 mm is flat to the file's rounding: its noise of 0.29 mm is not the surface's.
TEST(EvaluateMap, EntropyNeedsMoreThanTheRoundingOfTheFile) {
  PointCloud plane;
  for (int i = 0; i < 900; ++i) {
    const double x = 0.05 * (i % 30), y = 0.05 * (i / 30);
    plane.positions.push_back(Eigen::Vector3d(x, y, std::round(1000.0 * (0.31 * x + 0.17 * y)) / 1000.0).cast<float>());
  }
  EvaluationOptions options = options_for({"mme"});
  options.mme_radius_m = 0.25;
  EXPECT_FALSE(fields_of(evaluate_map(plane, options).metrics, "mean_map_entropy").at("value").is_null());
  plane.file_step_m = 0.001;
  const MapEvaluation found = evaluate_map(plane, options);
  EXPECT_TRUE(fields_of(found.metrics, "mean_map_entropy").at("value").is_null());
  const Evaluation pair = evaluate(plane, plane, options);
  EXPECT_TRUE(fields_of(pair.metrics, "mean_map_entropy").at("value").is_null());
  EXPECT_TRUE(fields_of(pair.metrics, "mean_map_entropy").at("reference").at("value").is_null());
}

TEST(EvaluateMap, CropsAndThins) {
  EvaluationOptions options = options_for({"density"});
  options.crop = Box3d{{-0.5, -0.5, -0.5}, {10, 0.5, 0.5}};
  const PointCloud map = small_map({{0, 0, 0}, {1, 0, 0}, {3, 0, 0}, {3, 5, 0}});
  EXPECT_EQ(fields_of(evaluate_map(map, options).metrics, "point_spacing").at("n"), 3);
  options.voxel_m = 2.0;  // {0, 1} and {3}
  EXPECT_EQ(fields_of(evaluate_map(map, options).metrics, "point_spacing").at("value"), 2.5);
  options.crop = Box3d{{100, 0, 0}, {101, 1, 1}};
  EXPECT_EQ(refusal_of<UnsupportedError>([&] { evaluate_map(map, options); }), "crop: no point of the map is inside");
}

TEST(EvaluateMap, WithoutColor) {
  const PointCloud bare = small_map({{0, 0, 0}, {1, 0, 0}});
  const MapEvaluation found = evaluate_map(bare, {});
  EXPECT_TRUE(fields_of(found.metrics, "color_consistency").at("value").is_null());
  EXPECT_EQ(fields_of(found.metrics, "point_spacing").at("value"), 1.0);
  EXPECT_THAT(warning_ids(found.warnings), ElementsAre("no_color", "mean_map_entropy_no_points"));
  EXPECT_THAT(refusal_of<UnsupportedError>([&] { evaluate_map(bare, options_for({"CCS"})); }),
              HasSubstr("the map has no color"));
}

TEST(EvaluateMap, OnePlace) {
  const MapEvaluation found = evaluate_map(test::gray_map({{1, 2, 3}, {1, 2, 3}}), options_for({"density"}));
  EXPECT_EQ(fields_of(found.metrics, "point_spacing"),
            (Json{{"value", nullptr}, {"mean", nullptr}, {"n", 1}, {"n_copies", 1}}));
  EXPECT_THAT(warning_ids(found.warnings), ElementsAre("point_spacing_one_place"));
}

TEST(EvaluateMap, RefusesWhatCannotBeEvaluated) {
  EXPECT_EQ(refusal_of<InputError>([] { evaluate_map({}, {}); }), "the map has no points");
  EXPECT_EQ(refusal_of<InputError>([] {
              evaluate_map(small_map({{0, 0, NAN}}), {});
            }),
            "the map has a point that is not finite");
  EXPECT_THAT(refusal_of<UsageError>([] { evaluate_map(painted_sheet(10, 1), options_for({"chamfer"})); }),
              HasSubstr("chamfer needs a reference map"));
}

TEST(EvaluateMap, TheSameForAnyNumberOfThreads) {
  const auto metrics = [] { return fields_of(evaluate_map(painted_sheet(100'000, 3), {}).metrics).dump(); };
  const std::string expected = metrics();
  const ExecutionScope limit({.threads = 1});
  EXPECT_EQ(metrics(), expected);
}

}  // namespace map_evaluation_test
}  // namespace cmap

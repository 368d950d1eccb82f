#include "cmap/eval/sensitivity.hpp"

#include "eval/eval_testing.hpp"

namespace cmap {
namespace sensitivity_test {

using test::options_for;

/// A square of points 0.5 m apart around the origin, at this height.
PointCloud square_at(float z_m) {
  PointCloud map;
  for (int x = -10; x <= 10; ++x) {
    for (int y = -10; y <= 10; ++y) {
      map.positions.push_back({0.5f * static_cast<float>(x), 0.5f * static_cast<float>(y), z_m});
    }
  }
  return map;
}

nlohmann::ordered_json band_of(const PointCloud& reference, const PointCloud& estimate,
                               const EvaluationOptions& options) {
  SensitivityBand band = sensitivity_band(reference, estimate, options, Eigen::Matrix4d::Identity());
  band.include(evaluate(reference, estimate, options).metrics);
  return sensitivity_json(band.found(options)).at("metrics");
}

/// Two parallel planes: a shift across them by d changes both means by d, one along them only in second order, and a
/// small turn about the middle raises one half as much as it lowers the other.
TEST(Sensitivity, OfParallelPlanesIsTheShiftAcross) {
  EvaluationOptions options = options_for({"chamfer", "accuracy"});
  options.thresholds_m = {0.26};
  const auto band = band_of(square_at(0.0f), square_at(0.25f), options);
  EXPECT_NEAR(band.at("chamfer").at("lowest").get<double>(), 2.0 * (0.25 - 0.01), 1e-6);
  EXPECT_NEAR(band.at("chamfer").at("highest").get<double>(), 2.0 * (0.25 + 0.01), 1e-6);
  const auto& accuracy = band.at("accuracy").at("per_threshold")[0];
  EXPECT_EQ(accuracy.at("threshold_m"), 0.26);
  EXPECT_NEAR(accuracy.at("lowest").get<double>(), 0.24, 1e-6);
  EXPECT_LE(accuracy.at("highest").get<double>(), 0.26);
}

/// Ten times as far and ten times the band: the derivative is constant here.
TEST(Sensitivity, GrowsWithTheMotion) {
  EvaluationOptions options = options_for({"chamfer"});
  options.sensitivity_translation_m = 0.1;
  options.sensitivity_rotation_deg = 1e-6;
  const auto band = band_of(square_at(0.0f), square_at(0.25f), options);
  EXPECT_NEAR(band.at("chamfer").at("highest").get<double>() - band.at("chamfer").at("lowest").get<double>(), 0.4,
              1e-6);
}

/// Points at the end of a lever of 5 m move by 5 m sin 1 degree.
TEST(Sensitivity, TurnsAreAboutTheCentroid) {
  const PointCloud map = test::gray_map({{995, 0, 0}, {1005, 0, 0}});
  EvaluationOptions options = options_for({"hausdorff"});
  options.sensitivity_translation_m = 1e-6;
  options.sensitivity_rotation_deg = 1.0;
  const auto band = band_of(map, map, options);
  EXPECT_EQ(band.at("hausdorff").at("lowest"), 0.0);
  EXPECT_NEAR(band.at("hausdorff").at("highest").get<double>(), 10.0 * std::sin(0.5 * M_PI / 180.0), 1e-4);
}

TEST(Sensitivity, HoldsTheValueItself) {
  const PointCloud reference = test::painted_sheet(800, 1), estimate = test::painted_sheet(700, 2);
  const EvaluationOptions options = options_for({"default"});
  const Evaluation evaluation = evaluate(reference, estimate, options);
  const auto band = band_of(reference, estimate, options);
  for (const MetricRecord& metric : evaluation.metrics) {
    if (!std::isfinite(metric.record.value.value_or(NAN))) continue;
    const auto& range = band.at(std::string(metric.info->id));
    EXPECT_LE(range.at("lowest").get<double>(), *metric.record.value) << metric.info->id;
    EXPECT_GE(range.at("highest").get<double>(), *metric.record.value) << metric.info->id;
  }
}

}  // namespace sensitivity_test
}  // namespace cmap

#include <cmath>

#include "cmap/core/execution.hpp"
#include "metrics/measured.hpp"

namespace cmap {
namespace local_color_recall_test {

/// The metric's numbers, and the field that it counts.
struct Recall {
  std::uint64_t n_reference, n_covered, n_recalled;
  double value, coverage, conditional;
  RecallCurve curve;
  Array<RecallClass> classes;
};

Recall recall(const MapPair& pair, double tau, double radius_m, bool curve = false) {
  MetricOptions options;
  options.lcr_tau = tau;
  options.lcr_radius_m = radius_m;
  options.lcr_curve = curve;
  MetricInputs inputs(options, pair);
  std::vector<Warning> warnings;
  const Record record = measure(catalog::local_color_recall, inputs, warnings);
  const auto count = [&](const char* name) { return static_cast<std::uint64_t>(test::number(record, name)); };
  return {count("n_reference"),
          count("n_covered"),
          count("n_recalled"),
          *record.value,
          test::number(record, "coverage"),
          test::number(record, "conditional"),
          inputs.recall->curve,
          inputs.recall->classes};
}

Recall recall(const test::Clouds& clouds, double tau, double radius_m, bool curve = false) {
  return recall(clouds.pair(), tau, radius_m, curve);
}

/// One black reference point and one estimated point of the given color in the same place.
Recall recall_of_color(Rgb8 color, double tau) {
  return recall({test::cloud_of({{0, 0, 0}}, {{0, 0, 0}}), test::cloud_of({{0, 0, 0}}, {color})}, tau, 0.5);
}

/// Brute force: classes in the reference's order.
Array<RecallClass> classes_by_definition(const test::Clouds& clouds, double tau, double radius_m) {
  Array<RecallClass> classes(clouds.reference.size(), RecallClass::kNotCovered);
  for (std::size_t j = 0; j < clouds.reference.size(); ++j) {
    for (std::size_t i = 0; i < clouds.estimate.size(); ++i) {
      if ((clouds.reference.world(j) - clouds.estimate.world(i)).norm() > radius_m) continue;
      const double color = (test::unit_color(clouds.reference, j) - test::unit_color(clouds.estimate, i)).norm();
      classes[j] = std::max(classes[j], color <= 3.0 * tau ? RecallClass::kRecalled : RecallClass::kWrongColor);
    }
  }
  return classes;
}

void expect_same(const Recall& found, const Recall& expected) {
  EXPECT_EQ(found.n_reference, expected.n_reference);
  EXPECT_EQ(found.n_covered, expected.n_covered);
  EXPECT_EQ(found.n_recalled, expected.n_recalled);
}

TEST(LocalColorRecall, HandComputed) {
  // Covered and right, covered and wrong, not covered, covered and right by the farther of two.
  const PointCloud reference = test::cloud_of({{0, 0, 0}, {10, 0, 0}, {20, 0, 0}, {30, 0, 0}},
                                              {{10, 10, 10}, {10, 10, 10}, {10, 10, 10}, {10, 10, 10}});
  const PointCloud estimate = test::cloud_of({{0.25f, 0, 0}, {10, 0, 0}, {21, 0, 0}, {30.1f, 0, 0}, {30.4f, 0, 0}},
                                             {{20, 20, 20}, {255, 255, 255}, {10, 10, 10}, {255, 0, 0}, {10, 0, 10}});
  const test::Clouds clouds{reference, estimate};
  const MapPair pair = clouds.pair();
  const Recall found = recall(pair, 0.1, 0.5);
  EXPECT_EQ(found.n_reference, 4U);
  EXPECT_EQ(found.n_covered, 3U);
  EXPECT_EQ(found.n_recalled, 2U);
  EXPECT_EQ(found.value, 0.5);
  EXPECT_EQ(found.coverage, 0.75);
  EXPECT_DOUBLE_EQ(found.conditional, 2.0 / 3.0);
  EXPECT_EQ(in_original_order(pair.reference.index.points, found.classes),
            (Array<RecallClass>{RecallClass::kRecalled, RecallClass::kWrongColor, RecallClass::kNotCovered,
                                RecallClass::kRecalled}));
  EXPECT_TRUE(found.curve.tau.empty());
}

TEST(LocalColorRecall, AColorAtExactlyThreeTauIsRight) {
  EXPECT_EQ(recall_of_color({153, 0, 0}, 0.2).n_recalled, 1U);  // 153 / 255 = 3 x 0.2
  EXPECT_EQ(recall_of_color({154, 0, 0}, 0.2).n_recalled, 0U);
  EXPECT_EQ(recall_of_color({0, 0, 51}, 1.0 / 15.0).n_recalled, 1U);
  EXPECT_EQ(recall_of_color({0, 0, 52}, 1.0 / 15.0).n_recalled, 0U);
  EXPECT_EQ(recall_of_color({60, 0, 80}, 100.0 / 765.0).n_recalled, 1U);  // 60^2 + 80^2 = 100^2
  EXPECT_EQ(recall_of_color({60, 1, 80}, 100.0 / 765.0).n_recalled, 0U);
  EXPECT_EQ(recall_of_color({76, 0, 0}, 0.1).n_recalled, 1U);  // of 76.5
  EXPECT_EQ(recall_of_color({77, 0, 0}, 0.1).n_recalled, 0U);
}

TEST(LocalColorRecall, AFloatColorAtExactlyThreeTauIsRight) {
  test::Clouds clouds{test::cloud_of({{0, 0, 0}}), test::cloud_of({{0, 0, 0}})};
  clouds.reference.colors = Array<RgbF>{{0.125f, 0, 0}};
  clouds.estimate.colors = Array<RgbF>{{0.875f, 0, 0}};
  EXPECT_EQ(recall(clouds, 0.25, 0.5).n_recalled, 1U);
  EXPECT_EQ(recall(clouds, 0.2499999, 0.5).n_recalled, 0U);
}

TEST(LocalColorRecall, ThreeTauIsComparedInDouble) {
  // 153 / 255 = 0.6: as squares of floats, 3 tau below it by a billionth would be the same number.
  EXPECT_EQ(recall_of_color({153, 0, 0}, 0.2 - 1e-9).n_recalled, 0U);
  EXPECT_EQ(recall_of_color({153, 0, 0}, 0.2 - 1e-13).n_recalled, 1U) << "within 1e-12";
}

TEST(LocalColorRecall, TheRadiusIsInclusive) {
  const test::Clouds clouds{test::cloud_of({{0, 0, 0}}, {{0, 0, 0}}), test::cloud_of({{0.5f, 0, 0}}, {{0, 0, 0}})};
  EXPECT_EQ(recall(clouds, 0.1, 0.5).n_recalled, 1U);
  // 2^-24 m is the step from 0.5 to 1 m; two of them belong to the threshold.
  EXPECT_EQ(recall(clouds, 0.1, 0.5 - 2 * 0x1p-24).n_covered, 1U);
  EXPECT_EQ(find_recall(clouds.pair(), {.radius_m = 0.5 - 1e-9, .radius_steps = 0.0}).classes[0],
            RecallClass::kNotCovered);
  const Recall none = recall(clouds, 0.1, 0.5 - 2.5 * 0x1p-24);
  EXPECT_EQ(none.n_covered, 0U);
  EXPECT_EQ(none.value, 0.0);
  EXPECT_TRUE(std::isnan(none.conditional));
}

/// Points without color of a reference count nowhere, those of an estimate cover only.
TEST(LocalColorRecall, MissingColorsByHand) {
  test::Clouds clouds{test::cloud_of({{0, 0, 0}, {10, 0, 0}, {20, 0, 0}, {30, 0, 0}, {40, 0, 0}}),
                      test::cloud_of({{0.25f, 0, 0}, {10.25f, 0, 0}, {30, 0, 0}, {30.25f, 0, 0}, {40, 0, 0}})};
  clouds.reference.colors = Array<RgbF>{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {NAN, NAN, NAN}};
  clouds.estimate.colors = Array<RgbF>{{0, 0, 0}, {NAN, NAN, NAN}, {NAN, NAN, NAN}, {0.25f, 0, 0}, {0, 0, 0}};
  const MapPair pair = clouds.pair();
  const Recall found = recall(pair, 0.1, 0.5, true);
  EXPECT_EQ(found.n_reference, 4U);
  EXPECT_EQ(found.n_covered, 3U);
  EXPECT_EQ(found.n_recalled, 2U);
  EXPECT_EQ(found.curve.value.front(), 0.25) << "0.25 is not within 0.06";
  EXPECT_EQ(in_original_order(pair.reference.index.points, found.classes),
            (Array<RecallClass>{RecallClass::kRecalled, RecallClass::kWrongColor, RecallClass::kNotCovered,
                                RecallClass::kRecalled, RecallClass::kNoColor}));
}

/// Leaving colors out one by one changes the others' classes in nothing but what they lost.
TEST(LocalColorRecall, MissingColorsEqualTheDefinition) {
  test::Clouds clouds = test::two_sheets(1500, 1200);
  const auto with_gaps = [](const PointCloud& cloud, std::size_t every) {
    Array<RgbF> colors(cloud.size());
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const Eigen::Vector3f c = test::unit_color(cloud, i).cast<float>();
      colors[i] = i % every == 0 ? RgbF{NAN, NAN, NAN} : RgbF{c.x(), c.y(), c.z()};
    }
    PointCloud result = cloud;
    result.colors = colors;
    return result;
  };
  clouds = {with_gaps(clouds.reference, 7), with_gaps(clouds.estimate, 3)};
  const MapPair pair = clouds.pair();
  const Recall found = recall(pair, 0.1, 0.5);
  Array<RecallClass> expected = classes_by_definition(clouds, 0.1, 0.5);  // NaN is not at most 3 tau
  for (std::size_t i = 0; i < expected.size(); i += 7) expected[i] = RecallClass::kNoColor;
  EXPECT_EQ(in_original_order(pair.reference.index.points, found.classes), expected);
}

TEST(LocalColorRecall, EqualsTheDefinition) {
  const test::Clouds clouds = test::two_sheets();
  const MapPair pair = clouds.pair();
  for (double tau : {0.02, 0.05, 0.1, 0.2}) {
    for (double radius_m : {0.1, 0.5, 2.0}) {
      SCOPED_TRACE(testing::Message() << "tau " << tau << ", radius " << radius_m);
      const Recall found = recall(pair, tau, radius_m);
      const Array<RecallClass> expected = classes_by_definition(clouds, tau, radius_m);
      EXPECT_EQ(in_original_order(pair.reference.index.points, found.classes), expected);
      const auto count = [&](RecallClass c) {
        return static_cast<std::uint64_t>(std::count(expected.begin(), expected.end(), c));
      };
      EXPECT_EQ(found.n_recalled, count(RecallClass::kRecalled));
      EXPECT_EQ(found.n_covered, found.n_recalled + count(RecallClass::kWrongColor));
    }
  }
}

TEST(LocalColorRecall, OfAMapAndItselfIsOne) {
  // Coincident points of different colors too: each finds its own.
  PointCloud repainted = test::painted_triplicates(300);
  test::paint(repainted, 17);
  for (const PointCloud& cloud : {test::two_sheets().reference, test::painted_triplicates(300), repainted}) {
    const Recall same = recall({cloud, cloud}, 1e-6, 1e-6, true);
    EXPECT_EQ(same.value, 1.0);
    EXPECT_EQ(same.coverage, 1.0);
    EXPECT_DOUBLE_EQ(same.curve.area, 1.0);
  }
}

TEST(LocalColorRecall, RisesWithTauUpToTheCoverage) {
  const MapPair pair = test::two_sheets().pair();
  std::uint64_t before = 0;
  for (double tau = 0.01; tau < 0.7; tau += 0.03) {
    const Recall found = recall(pair, tau, 0.5);
    EXPECT_GE(found.n_recalled, before);
    EXPECT_LE(found.n_recalled, found.n_covered);
    before = found.n_recalled;
  }
  // No two colors are farther apart than sqrt 3 < 3 x 0.6.
  const Recall any = recall(pair, 0.6, 0.5);
  EXPECT_EQ(any.n_recalled, any.n_covered);
  EXPECT_LT(any.n_covered, any.n_reference);
}

TEST(LocalColorRecall, ValueAndCoverageRiseWithTheRadius) {
  const MapPair pair = test::two_sheets().pair();
  Recall before = recall(pair, 0.1, 0.02);
  for (double radius_m : {0.05, 0.1, 0.2, 0.4, 0.8, 1.6, 100.0}) {
    const Recall after = recall(pair, 0.1, radius_m);
    EXPECT_GE(after.n_covered, before.n_covered);
    EXPECT_GE(after.n_recalled, before.n_recalled);
    EXPECT_LE(after.n_recalled, after.n_covered);
    before = after;
  }
  EXPECT_EQ(before.coverage, 1.0);
}

TEST(LocalColorRecall, AppendedEstimatePointsNeverLowerIt) {
  test::Clouds clouds = test::two_sheets();
  Recall before = recall(clouds, 0.1, 0.5);
  for (unsigned step = 0; step < 3; ++step) {
    PointCloud more = test::sheet_cloud(500, 30 + step);
    test::paint(more, step);
    clouds.estimate = test::appended(clouds.estimate, more);
    const Recall after = recall(clouds, 0.1, 0.5);
    EXPECT_GE(after.n_covered, before.n_covered);
    EXPECT_GT(after.n_recalled, before.n_recalled);
    before = after;
  }
}

TEST(LocalColorRecall, TheCurveIsOneRecallForEachTau) {
  const MapPair pair = test::two_sheets().pair();
  for (double tau : {0.01, 0.1, 0.5}) {  // below, among and above those of the curve
    const Recall found = recall(pair, tau, 0.5, true);
    EXPECT_EQ(found.n_recalled, recall(pair, tau, 0.5).n_recalled);
    const RecallCurve& curve = found.curve;
    ASSERT_EQ(curve.tau.size(), 15U);
    ASSERT_EQ(curve.value.size(), 15U);
    for (std::size_t i = 0; i < 15; ++i) {
      EXPECT_DOUBLE_EQ(curve.tau[i], 0.02 * static_cast<double>(i + 1));
      EXPECT_EQ(curve.value[i], recall(pair, curve.tau[i], 0.5).value);
    }
    EXPECT_TRUE(std::is_sorted(curve.value.begin(), curve.value.end()));
    EXPECT_LT(curve.value.front(), curve.value.back());
  }
}

TEST(LocalColorRecall, AreaUnderTheCurveByHand) {
  // A difference of 153 / 255 is right from tau = 0.2 on: (0.02 / 2 + 0.1) / 0.28.
  const test::Clouds clouds{test::cloud_of({{0, 0, 0}}, {{0, 0, 0}}), test::cloud_of({{0, 0, 0}}, {{0, 153, 0}})};
  const RecallCurve curve = recall(clouds, 0.1, 0.5, true).curve;
  EXPECT_EQ(curve.value[8], 0.0);
  EXPECT_EQ(curve.value[9], 1.0);
  EXPECT_DOUBLE_EQ(curve.area, 11.0 / 28.0);
}

TEST(LocalColorRecall, IsInvariantUnderMotionPermutationTranslationAndScale) {
  const test::Clouds clouds = test::two_sheets();
  const Recall expected = recall(clouds, 0.1, 0.5);
  // No pair of this size lies within rounding of the radius.
  expect_same(recall(test::moved(clouds, test::rigid_motion()), 0.1, 0.5), expected);
  expect_same(recall(test::permuted(clouds), 0.1, 0.5), expected);
  expect_same(recall(test::moved(clouds, test::translation({1e6, -1e6, 1e6})), 0.1, 0.5), expected);
  expect_same(recall(test::moved(clouds, test::scaling(4.0)), 0.1, 2.0), expected);
}

TEST(LocalColorRecall, SameForAnyNumberOfThreads) {
  const MapPair pair = test::two_sheets(90000, 80000).pair();
  const Recall many = recall(pair, 0.02, 0.3);
  const ExecutionScope limit({.threads = 1});
  EXPECT_EQ(recall(pair, 0.02, 0.3).classes, many.classes);
}

TEST(LocalColorRecall, NeedsColorsInBothMaps) {
  test::Clouds clouds = test::two_sheets(10, 10);
  clouds.reference.colors = std::monostate{};
  EXPECT_THROW(recall(clouds, 0.1, 0.5), std::invalid_argument);
}

}  // namespace local_color_recall_test
}  // namespace cmap

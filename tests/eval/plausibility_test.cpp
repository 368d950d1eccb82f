#include "plausibility.hpp"

#include <cmath>
#include <random>

#include "eval/eval_testing.hpp"

namespace cmap {
namespace plausibility_test {

using test::options_for;
using test::warning_ids;
using ::testing::Contains;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::Not;
using Cause = CoordinateStep::Cause;

/// A cloud of world coordinates as a reader would keep it.
PointCloud map_of(const std::vector<Eigen::Vector3d>& points) {
  Box3d box{points.front(), points.front()};
  for (const Eigen::Vector3d& x : points) box = {box.min.cwiseMin(x), box.max.cwiseMax(x)};
  PointCloud map;
  map.origin = choose_origin(box);
  for (const Eigen::Vector3d& x : points) map.positions.push_back((x - map.origin).cast<float>());
  return map;
}

/// Points anywhere in a box, each coordinate after `store`.
template <class Store>
PointCloud random_map(std::size_t n, const Box3d& box, Store&& store) {
  std::mt19937 random(7);
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < n; ++i) {
    Eigen::Vector3d x;
    for (int axis = 0; axis < 3; ++axis) {
      const double share = static_cast<double>(random()) / 4294967296.0;
      x[axis] = store(box.min[axis] + share * (box.max[axis] - box.min[axis]));
    }
    points.push_back(x);
  }
  return map_of(points);
}

const Box3d kUtm{{500000, 5400000, 300}, {500100, 5400100, 310}};
constexpr double kMillimeter = 0.001;

double as_double(double x) { return x; }
double as_float(double x) { return static_cast<double>(static_cast<float>(x)); }

/// As printf's %.<digits>g.
auto printed(int digits) {
  return [digits](double x) {
    const double step = std::pow(10.0, std::floor(std::log10(std::abs(x))) + 1 - digits);
    return std::round(x / step) * step;
  };
}

TEST(CoarseStep, OfFloat32InUtm) {
  for (const std::size_t n : {12U, 30000U}) {
    const auto step = coarse_step(random_map(n, kUtm, as_float), kMillimeter);
    ASSERT_TRUE(step) << n;
    EXPECT_EQ(step->step_m, 0.5) << "2^22 <= 5.4e6 < 2^23, 24 bits: 2^-1";
    EXPECT_EQ(step->axis, 1);
    EXPECT_EQ(step->cause, Cause::kFloat32);
  }
  EXPECT_FALSE(coarse_step(random_map(30000, kUtm, as_double), kMillimeter));
}

/// Text of floats: 5400000.5 and 500012.03125 keep their digits, 303.127 does not.
TEST(CoarseStep, OfFloat32PrintedWithFewerDigits) {
  for (const double decimal : {1e-6, 1e-3, 1e-2}) {
    const auto printed_float = [&](double x) { return std::round(as_float(x) / decimal) * decimal; };
    const auto step = coarse_step(random_map(1000, kUtm, printed_float), kMillimeter);
    ASSERT_TRUE(step) << decimal;
    EXPECT_EQ(step->step_m, 0.5) << decimal;
    EXPECT_EQ(step->cause, Cause::kFloat32) << decimal;
    const auto printed_double = [&](double x) { return std::round(x / decimal) * decimal; };
    const auto other = coarse_step(random_map(1000, kUtm, printed_double), kMillimeter);
    EXPECT_TRUE(!other || other->cause == Cause::kDigits) << decimal;
  }
}

TEST(CoarseStep, OfFloat16) {
  const auto as_half = [](double x) { return std::round(x / 0.03125) * 0.03125; };  // 32 to 64: 2^5 / 2^10
  const auto step = coarse_step(random_map(200, {{33, 33, 33}, {63, 63, 63}}, as_half), kMillimeter);
  ASSERT_TRUE(step);
  EXPECT_EQ(step->step_m, 0.03125);
  EXPECT_EQ(step->cause, Cause::kFloat16);
}

TEST(CoarseStep, OfFewPrintedDigits) {
  for (const auto& [digits, step_m] : {std::pair{6, 10.0}, {7, 1.0}, {8, 0.1}}) {
    const auto step = coarse_step(random_map(20, kUtm, printed(digits)), kMillimeter);
    ASSERT_TRUE(step) << digits;
    EXPECT_EQ(step->step_m, step_m) << "of northings, which have seven digits before the point";
    EXPECT_EQ(step->axis, 1);
    EXPECT_EQ(step->cause, Cause::kDigits);
  }
}

TEST(CoarseStep, OfHundredthsWhereMillimetersCount) {
  const PointCloud map = random_map(1000, {{0, 0, 0}, {90, 90, 9}}, [](double x) { return std::round(x * 100) / 100; });
  const auto step = coarse_step(map, kMillimeter);
  ASSERT_TRUE(step);
  EXPECT_EQ(step->step_m, 0.01);
  EXPECT_FALSE(coarse_step(map, 0.02));
}

TEST(CoarseStep, IsNoneOfMillimeters) {
  const auto millimeters = [](double x) { return std::round(x * 1000) / 1000; };
  EXPECT_FALSE(coarse_step(random_map(1000, kUtm, millimeters), kMillimeter));
  EXPECT_FALSE(coarse_step(random_map(1000, {{0, 0, 0}, {90, 90, 9}}, millimeters), kMillimeter));
}

TEST(CoarseStep, IsNoneOfARaster) {
  std::vector<Eigen::Vector3d> half_meters, whole_meters;
  for (int i = 0; i < 400; ++i) {
    const double height = 300 + std::sin(i);  // many digits
    half_meters.emplace_back(500000.25 + 0.5 * (i % 20), 5400000.25 + 0.5 * (i / 20), height);
    whole_meters.emplace_back(i % 20, i / 20, height);
  }
  EXPECT_FALSE(coarse_step(map_of(half_meters), kMillimeter));
  EXPECT_FALSE(coarse_step(map_of(whole_meters), kMillimeter));
}

/// Half a meter is the step of float32 at 5.4e6 m, but not at 5e5 m: a LAS file of that scale.
TEST(CoarseStep, OfAScaleThatLooksLikeFloats) {
  const auto halves = [](double x) { return std::round(2.0 * x) / 2.0; };
  const auto step = coarse_step(random_map(1000, kUtm, halves), kMillimeter);
  ASSERT_TRUE(step);
  EXPECT_EQ(step->step_m, 0.5);
  EXPECT_EQ(step->cause, Cause::kGrid);
}

TEST(CoarseStep, OfAMapTooWideForItsOffsets) {
  const auto step = coarse_step(random_map(1000, {{-20000, 0, 0}, {20000, 1000, 50}}, as_double), kMillimeter);
  ASSERT_TRUE(step);
  EXPECT_EQ(step->step_m, std::ldexp(1.0, -9)) << "2^14 < 20000 < 2^15, 24 bits";
  EXPECT_EQ(step->axis, 0);
  EXPECT_EQ(step->cause, Cause::kOwnOffsets);
  EXPECT_FALSE(coarse_step(random_map(1000, {{-4000, 0, 0}, {4000, 1000, 50}}, as_double), kMillimeter));
}

TEST(CoarseStep, IsNotDecidedByOneFarPoint) {
  PointCloud map = random_map(1000, {{-40, -40, 0}, {40, 40, 9}}, as_double);
  map.positions[500] = {0, 30000, 0};
  EXPECT_FALSE(coarse_step(map, kMillimeter));
}

/// Ten by ten points on a plane, `side_m` between neighbors.
std::vector<Eigen::Vector3d> grid(double side_m, double height_m = 0.0) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 100; ++i) points.emplace_back(side_m * (i % 10), side_m * (i / 10), height_m);
  return points;
}

TEST(CloudBody, LeavesOutFarPointsAndNamesTheFarthest) {
  std::vector<Eigen::Vector3d> points = grid(1.0);
  points[17] = {0, 0, 6000};
  points[60] = {0, -70000, 0};
  const CloudBody body = body_of(map_of(points));
  EXPECT_EQ(body.n_strays, 2U);
  EXPECT_EQ(body.farthest, 60U);
  EXPECT_NEAR(body.farthest_m, 70000, 10);
  EXPECT_EQ(body.box.min, Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(body.box.max, Eigen::Vector3d(9, 9, 0));
}

TEST(CloudBody, IsAllOfAMapWithATower) {
  std::vector<Eigen::Vector3d> points = grid(1.0);
  points[17] = {4, 4, 60};
  const CloudBody body = body_of(map_of(points));
  EXPECT_EQ(body.n_strays, 0U);
  EXPECT_EQ(body.box.max, Eigen::Vector3d(9, 9, 60));
}

/// The messages of one id.
std::vector<std::string> said(const std::vector<Warning>& warnings, std::string_view id) {
  std::vector<std::string> messages;
  for (const Warning& warning : warnings) {
    if (warning.id == id) messages.push_back(warning.message);
  }
  return messages;
}

std::vector<Warning> warnings_of(const std::vector<Eigen::Vector3d>& reference,
                                 const std::vector<Eigen::Vector3d>& estimate, EvaluationOptions options) {
  return evaluate(map_of(reference), map_of(estimate), options).warnings;
}

std::vector<Warning> warnings_of(const std::vector<Eigen::Vector3d>& reference,
                                 const std::vector<Eigen::Vector3d>& estimate) {
  return warnings_of(reference, estimate, options_for({"chamfer", "rmse"}));
}

TEST(Frames, SizesApartAreNamedWithTheirFactor) {
  const auto messages = [](double factor) {
    return said(warnings_of(grid(1.0), grid(factor)), "units_or_frame_mismatch");
  };
  EXPECT_THAT(messages(2.4), ::testing::SizeIs(0));
  EXPECT_THAT(messages(1 / 2.4), ::testing::SizeIs(0));
  EXPECT_THAT(messages(3), Contains(AllOf(HasSubstr("a factor of 3: "), HasSubstr("a scale of its own"))));
  EXPECT_THAT(messages(1 / 3.0), Contains(HasSubstr("a factor of 3: ")));
  EXPECT_THAT(messages(3.28084), Contains(HasSubstr("is the estimate in feet")));
  EXPECT_THAT(messages(100), Contains(HasSubstr("is the estimate in centimeters")));
  EXPECT_THAT(messages(0.001), Contains(HasSubstr("is the reference in millimeters")));
}

TEST(Frames, OneStrayMakesNoSize) {
  std::vector<Eigen::Vector3d> estimate = grid(1.0);
  estimate[5] = {6000, 0, 0};
  EXPECT_THAT(said(warnings_of(grid(1.0), estimate), "units_or_frame_mismatch"), ::testing::SizeIs(0));
}

TEST(Strays, ThePointThatDecidesRmseIsNamed) {
  std::vector<Eigen::Vector3d> estimate = grid(1.0, 0.125);
  estimate[42] = {2, 4, 6000.0};
  // 99 distances of 1/8 m remain; with the stray, sqrt((6000^2 + 99 / 64) / 100) = 600.
  EXPECT_THAT(said(warnings_of(grid(1.0), estimate), "stray_points"),
              Contains(AllOf(HasSubstr("point 43 of the estimate's 100, at (2, 4, 6000), lies 6000 m"),
                             HasSubstr("without it RMSE is 0.125 m, not 600 m"))));
}

TEST(Strays, WhatIsLeftIsNoRounding) {
  std::vector<Eigen::Vector3d> estimate;
  for (int i = 0; i < 400; ++i) estimate.emplace_back(0.5 * (i % 20), 0.5 * (i / 20), 0.125);
  std::vector<Eigen::Vector3d> reference = estimate;
  for (Eigen::Vector3d& x : reference) x.z() = 0.0;
  estimate[7].z() = 3e8;  // squared, 9e16: the sum of the others' squares is lost in it
  const auto messages = said(warnings_of(reference, estimate), "stray_points");
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_THAT(messages[0], AllOf(HasSubstr("one stray point"), HasSubstr("without it RMSE is 0.125 m")));
}

TEST(Strays, OfTheReferenceDecideChamfer) {
  std::vector<Eigen::Vector3d> reference = grid(1.0);
  reference[7] = {0, 0, -500.0};
  // 99 distances of 1/8 m; with the stray, (500.125 + 99 / 8) / 100 = 5.125.
  const auto messages = said(warnings_of(reference, grid(1.0, 0.125)), "stray_points");
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_THAT(messages[0], AllOf(HasSubstr("point 8 of the reference's 100"), HasSubstr("0.125 m, not 5.125 m")));
}

TEST(Strays, UpToThreeOfManyAreCounted) {
  std::vector<Eigen::Vector3d> reference, estimate;
  for (int i = 0; i < 900; ++i) {
    reference.emplace_back(i % 30, i / 30, 0);
    estimate.emplace_back(i % 30, i / 30, 0.125);
  }
  for (int stray : {10, 20, 30}) estimate[static_cast<std::size_t>(stray)].z() = 1000.0 * stray;
  EXPECT_THAT(said(warnings_of(reference, estimate), "stray_points"),
              Contains(AllOf(HasSubstr("3 stray points"), HasSubstr("point 31 of"), HasSubstr("RMSE is 0.125 m"))));
}

TEST(Strays, AnOutlierAmongOthersIsNone) {
  std::vector<Eigen::Vector3d> estimate = grid(1.0, 0.125);
  for (std::size_t i = 0; i < 10; ++i) estimate[10 * i].z() = 50.0 + static_cast<double>(i);
  EXPECT_THAT(said(warnings_of(grid(1.0), estimate), "stray_points"), ::testing::SizeIs(0));
  EXPECT_THAT(said(warnings_of({{0, 0, 0}, {1, 0, 0}}, {{0, 0, 0}, {1, 0, 100}}), "stray_points"),
              ::testing::SizeIs(0));
}

TEST(Steps, AreSaidUnlessTheyAreARasters) {
  const auto messages = [](const std::vector<Eigen::Vector3d>& map) {
    return said(warnings_of(map, map), "coarse_coordinates");
  };
  std::vector<Eigen::Vector3d> raster, rounded;
  for (int i = 0; i < 400; ++i) {
    raster.emplace_back(500000 + i % 20, 5400000 + i / 20, 300 + std::sin(i));
    rounded.emplace_back(500000 + std::round(i % 20 * 2.5) / 10, 5400000 + i / 40, 300 + std::sin(i));
  }
  std::vector<Eigen::Vector3d> half_meters, scale;
  for (int i = 0; i < 400; ++i) {
    half_meters.emplace_back(500000 + 0.5 * (i % 20), 5400000 + 0.5 * (i / 20),
                             300 + std::round(100 * std::sin(i)) / 100);
    scale.emplace_back(500000 + 0.5 * (i % 10), 5400000 + 0.5 * (i / 10 % 10), 300 + 0.5 * (i / 200));
  }
  EXPECT_THAT(messages(half_meters), ::testing::SizeIs(0)) << "at 5.4e6 m, float32 has steps of 0.5 m too";
  EXPECT_THAT(messages(scale),
              Contains(HasSubstr("comes in steps of 0.5 m, those of a raster or of the file's own scale")));
  EXPECT_THAT(messages(raster), ::testing::SizeIs(0));
  EXPECT_THAT(messages(rounded), Contains(HasSubstr("the estimate's y comes in steps of 1 m, as if rounded")));
}

TEST(Repeated, CopiesAreCounted) {
  std::vector<Eigen::Vector3d> once = grid(1.0), thrice;
  for (int time = 0; time < 3; ++time) thrice.insert(thrice.end(), once.begin(), once.end());
  const auto messages = said(warnings_of(once, thrice), "repeated_points");
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_THAT(messages[0], HasSubstr("200 of the estimate's 300 points (66.7 %)"));
  EXPECT_THAT(said(warnings_of(once, once), "repeated_points"), ::testing::SizeIs(0));
}

TEST(Repeated, PointsThatRoundingBroughtTogetherAreSaidOnce) {
  const PointCloud rounded = random_map(1000, {kUtm.min, kUtm.min + Eigen::Vector3d(3, 3, 0)}, as_float);
  const auto ids = warning_ids(evaluate(rounded, rounded, options_for({"chamfer"})).warnings);
  EXPECT_THAT(ids, Contains("coarse_coordinates"));
  EXPECT_THAT(ids, Not(Contains("repeated_points")));
}

/// Dense points on the same plane as grid(0.5): every 0.05 m.
std::vector<Eigen::Vector3d> dense_plane() {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 90 * 90; ++i) points.emplace_back(0.05 * (i % 90), 0.05 * (i / 90), 0.0);
  return points;
}

TEST(Spacing, ThresholdsBelowTheReferencesAreNamed) {
  EvaluationOptions options = options_for({"fitness"});
  // Within t of a grid of 0.5 m lies a share of pi t^2 / 0.25 of the plane, t < 0.25: a half up to t = 0.199.
  options.thresholds_m = {1.0, 0.22, 0.15, 0.1};
  const auto messages = said(warnings_of(grid(0.5), dense_plane(), options), "sparse_reference");
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_THAT(messages[0], AllOf(HasSubstr("a spacing of 0.5 m"), HasSubstr("the thresholds 0.15, 0.1 m")));
  options.thresholds_m = {1.0, 0.5};
  EXPECT_THAT(said(warnings_of(grid(0.5), dense_plane(), options), "sparse_reference"), ::testing::SizeIs(0));
}

TEST(Spacing, IsNoMatterOfOtherErrors) {
  const auto messages = [](const std::vector<Eigen::Vector3d>& estimate) {
    return said(warnings_of(grid(0.5), estimate, options_for({"fitness"})), "sparse_reference");
  };
  EXPECT_THAT(messages(grid(0.5)), ::testing::SizeIs(0));
  EXPECT_THAT(messages(grid(0.5, 0.06)), ::testing::SizeIs(0)) << "the reference's own points, moved";
  EXPECT_THAT(messages(grid(0.5, 5.0)), ::testing::SizeIs(0)) << "elsewhere";
}

TEST(Spacing, CopiesMakeAReferenceNoDenser) {
  std::vector<Eigen::Vector3d> once = grid(0.5), twice = once;
  twice.insert(twice.end(), once.begin(), once.end());
  EXPECT_THAT(said(warnings_of(twice, dense_plane(), options_for({"fitness"})), "sparse_reference"),
              Contains(HasSubstr("a spacing of 0.5 m")));
}

}  // namespace plausibility_test
}  // namespace cmap

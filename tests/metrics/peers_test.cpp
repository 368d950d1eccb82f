#include "cmap/metrics/peers.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>

#include "metrics/measured.hpp"

namespace cmap {
namespace {

using Doubles = std::vector<double>;

const Eigen::Vector3d kZero = Eigen::Vector3d::Zero();

Eigen::Matrix3d diagonal(double a, double b, double c) { return Eigen::Vector3d(a, b, c).asDiagonal(); }

double mapeval_distance(const Gaussian& reference, const Gaussian& estimate) {
  return mapeval_wasserstein_distances(std::vector<GaussianPair>{{{1, 2, 3}, reference, estimate}}).front().distance_m;
}

/// n points of the covariance that MapEval gets after all its divisions by n - 1.
Gaussian mapeval_gaussian(std::uint64_t n, const Eigen::Vector3d& mean, const Eigen::Matrix3d& covariance) {
  const auto m = static_cast<double>(n - 1);
  return {n, mean, covariance * (n > 10 ? m * m * m : m)};
}

Doubles random_squares(std::size_t n) {
  std::mt19937_64 random(1);
  Doubles sq_dist(n);
  for (double& sq : sq_dist) sq = std::pow(test::uniform(random), 4.0);
  return sq_dist;
}

TEST(MapEvalAccuracy, HandComputed) {
  // Distances 0.1, 0.4, 0.5, 2: the squares of three are within 0.3, that of 0.5 though 0.5 is not.
  const MapEvalAccuracy found = mapeval_accuracy(Doubles{0.01, 0.16, 0.25, 4.0}, Doubles{0.1, 0.45}, 0.3);
  EXPECT_EQ(found.n_correspondences, 3U);
  EXPECT_DOUBLE_EQ(found.accuracy_m[0], std::sqrt(0.01 / 3));
  EXPECT_DOUBLE_EQ(found.accuracy_m[1], std::sqrt(0.17 / 3));
  EXPECT_EQ(found.completeness, (Doubles{0.25, 0.5}));
}

TEST(MapEvalAccuracy, BothLimitsAreInclusive) {
  const MapEvalAccuracy found = mapeval_accuracy(Doubles{0.25}, Doubles{0.5, 0.499}, 0.25);
  EXPECT_EQ(found.n_correspondences, 1U);
  EXPECT_EQ(found.completeness, (Doubles{1.0, 0.0}));
  EXPECT_EQ(found.accuracy_m, (Doubles{0.5, 0.0}));
}

TEST(MapEvalAccuracy, WithoutCorrespondencesIsMissing) {
  const MapEvalAccuracy none = mapeval_accuracy(Doubles{4.0}, Doubles{0.2}, 1.0);
  EXPECT_EQ(none.n_correspondences, 0U);
  EXPECT_TRUE(std::isnan(none.accuracy_m[0]));
  EXPECT_EQ(none.completeness[0], 0.0);
}

TEST(MapEvalAccuracy, IsOursDeflatedByTheShareOfInliers) {
  const Doubles sq_dist = random_squares(5000);
  const Doubles thresholds{0.05, 0.1, 0.2};
  const MapEvalAccuracy theirs = mapeval_accuracy(sq_dist, thresholds, 0.5);
  const MapPair pair = test::pair_with(Array<double>(sq_dist.begin(), sq_dist.end()));
  const Record accuracy = test::measured(catalog::accuracy, pair, test::with_thresholds(thresholds));
  const Record fitness = test::measured(catalog::fitness, pair, test::with_thresholds(thresholds));
  for (std::size_t t = 0; t < 3; ++t) {
    const Record ours = test::at_threshold(accuracy, t);
    const double share = test::number(ours, "n") / static_cast<double>(theirs.n_correspondences);
    EXPECT_NEAR_RELATIVE(theirs.accuracy_m[t], *ours.value * std::sqrt(share), test::kSummation);
    EXPECT_LT(theirs.accuracy_m[t], *ours.value);
    EXPECT_EQ(theirs.completeness[t], *test::at_threshold(fitness, t).value);
  }
  EXPECT_LT(theirs.accuracy_m[0], theirs.accuracy_m[1]);
}

TEST(MapEvalWasserstein, DividesOnceUpToTenPointsAndThreeTimesBeyond) {
  // Diagonal covariances, where its Cholesky factor is the root: sqrt3 |s1 - s2|.
  const double once = mapeval_distance({10, kZero, diagonal(36, 36, 36)}, {10, kZero, diagonal(9, 9, 9)});
  EXPECT_NEAR_RELATIVE(once, std::numbers::sqrt3 * (2.0 - 1.0), test::kSummation);
  const double thrice =
      mapeval_distance({11, kZero, diagonal(4000, 4000, 4000)}, {11, kZero, diagonal(1000, 1000, 1000)});
  EXPECT_NEAR_RELATIVE(thrice, std::numbers::sqrt3 * (2.0 - 1.0), test::kSummation);
}

TEST(MapEvalWasserstein, RaisesEigenvaluesToAMillionth) {
  // Both shapes shrink to 1e-6 I: the distance of the means is left.
  const Gaussian a{101, {0.25, 0, 0}, diagonal(0.5, 0.1, 0.0)};
  const Gaussian b{101, {0.25, 0.5, 0}, diagonal(0.0, 0.0, 0.9)};
  EXPECT_NEAR(mapeval_distance(a, b), 0.5, 1e-12);
  EXPECT_NEAR_RELATIVE(
      mapeval_distance(mapeval_gaussian(20, kZero, diagonal(0, 0, 0)), mapeval_gaussian(20, kZero, diagonal(1, 1, 1))),
      std::numbers::sqrt3 * (1.0 - 1e-3), test::kSummation);
}

TEST(MapEvalWasserstein, TakesACholeskyFactorForTheRoot) {
  // S1 = I, S2 = [[1, 1/2], [1/2, 1]] and 1: the factor's diagonal is 1, sqrt(3)/2, 1, where the true root's trace is
  // sqrt(3/2) + sqrt(1/2) + 1.
  Eigen::Matrix3d s2 = Eigen::Matrix3d::Identity();
  s2(0, 1) = s2(1, 0) = 0.5;
  const double theirs =
      mapeval_distance(mapeval_gaussian(30, kZero, Eigen::Matrix3d::Identity()), mapeval_gaussian(30, kZero, s2));
  EXPECT_NEAR(theirs, std::sqrt(6.0 - 2.0 * (2.0 + std::numbers::sqrt3 / 2.0)), 1e-12);
  const double true_w = std::sqrt(6.0 - 2.0 * (std::sqrt(1.5) + std::sqrt(0.5) + 1.0));
  EXPECT_GT(theirs, true_w + 0.1);
}

TEST(MapEvalWasserstein, KeepsTheVoxels) {
  const MapPair pair = test::two_sheets().pair();
  const std::vector<GaussianPair> gaussians = gaussian_pairs(pair, 4.0, 20);
  const std::vector<VoxelDistance> theirs = mapeval_wasserstein_distances(gaussians);
  ASSERT_EQ(theirs.size(), gaussians.size());
  for (std::size_t i = 0; i < theirs.size(); ++i) {
    EXPECT_EQ(theirs[i].index, gaussians[i].index);
    // Of twenty and more points, a covariance below 4 m^2 becomes less than 0.01: in effect the distance of the means.
    EXPECT_NEAR(theirs[i].distance_m, (gaussians[i].reference.mean - gaussians[i].estimate.mean).norm(), 0.1);
  }
  EXPECT_TRUE(mapeval_wasserstein_distances({}).empty());
}

TEST(MapEvalEntropy, LeavesOneDimensionsConstantOnly) {
  const double e = std::numbers::e;
  const NeighborhoodShape shape{{10, 12, 3, 20}, {e * e, 1.0, 1.0, 0.0}, {0, 1, 0, 1}};
  const MapEvalEntropy found = mapeval_entropy(shape, 10);
  EXPECT_EQ(found.n_valid, 2U);
  // 1/2 ln(2 pi e det) for det = e^2 and 1
  EXPECT_DOUBLE_EQ(found.value, 0.5 * std::log(2.0 * std::numbers::pi * e) + 0.5);
  EXPECT_EQ(mapeval_entropy(shape, 3).n_valid, 3U);
  EXPECT_TRUE(std::isnan(mapeval_entropy(shape, 21).value));
}

TEST(Open3dRegistration, HandComputed) {
  const Doubles sq_dist{0.0, 0.25, 1.0, 4.0};
  const Open3dRegistration found = open3d_registration(sq_dist, 1.0);  // below, not at the threshold
  EXPECT_EQ(found.n_correspondences, 2U);
  EXPECT_EQ(found.fitness, 0.5);
  EXPECT_DOUBLE_EQ(found.inlier_rmse_m, std::sqrt(0.125));
  EXPECT_EQ(open3d_registration(sq_dist, 100.0).fitness, 1.0);
}

TEST(Open3dRegistration, WithoutInliersIsZeroLikeTheTool) {
  const Open3dRegistration none = open3d_registration(Doubles{1.0, 2.0}, 1.0);
  EXPECT_EQ(none.n_correspondences, 0U);
  EXPECT_EQ(none.fitness, 0.0);
  EXPECT_EQ(none.inlier_rmse_m, 0.0);
}

TEST(Open3dRegistration, IsOursWhereNoDistanceIsTheThreshold) {
  const Doubles sq_dist = random_squares(5000);
  for (double threshold_m : {0.05, 0.1, 0.7}) {
    const Open3dRegistration theirs = open3d_registration(sq_dist, threshold_m);
    const MapPair pair = test::pair_with(Array<double>(sq_dist.begin(), sq_dist.end()));
    const MetricOptions options = test::with_thresholds({threshold_m});
    EXPECT_EQ(theirs.fitness, *test::at_threshold(test::measured(catalog::fitness, pair, options), 0).value);
    EXPECT_NEAR_RELATIVE(theirs.inlier_rmse_m,
                         *test::at_threshold(test::measured(catalog::accuracy, pair, options), 0).value,
                         test::kSummation);
  }
}

TEST(CloudAnalyzer, CurveByHand) {
  // Thresholds 0.05, 0.1, 0.2, 0.3, 0.5, 1: F is 0, then 2/3 from 0.3 on (P 1/2, R 1), inclusive.
  const Doubles estimate{0.09, 4.0}, reference{0.0625};
  const CloudAnalyzerCurve curve = cloudanalyzer_curve(estimate, reference);
  ASSERT_EQ(curve.scores.size(), 6U);
  EXPECT_EQ(curve.scores[2].f1, 0.0);
  EXPECT_EQ(curve.scores[3].precision, 0.5);
  EXPECT_EQ(curve.scores[3].recall, 1.0);
  EXPECT_DOUBLE_EQ(curve.scores[3].f1, 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(curve.auc, (0.1 * (1.0 / 3.0) + 0.7 * (2.0 / 3.0)) / 0.95);
}

TEST(CloudAnalyzer, SummaryByHand) {
  const CloudAnalyzerSummary found = cloudanalyzer_summary(Doubles{1.0, 9.0, 25.0, 49.0});
  EXPECT_DOUBLE_EQ(found.mean_m, 4.0);
  EXPECT_EQ(found.median_m, 4.0);
  EXPECT_EQ(found.max_m, 7.0);
  EXPECT_DOUBLE_EQ(found.standard_deviation_m, std::sqrt(5.0));  // population
}

TEST(CloudAnalyzer, StructureRaisesEigenvaluesAndCountsVoxelsAmongEqualOnes) {
  const auto pair_at = [](std::int64_t x, double spread) {
    return GaussianPair{
        {x, 0, 0}, {101, kZero, diagonal(0, 0, 0)}, {101, kZero, 100.0 * diagonal(spread, spread, spread)}};
  };
  // Covariances 0 against s^2 I become 1e-6 I against s^2 I: sqrt 3 (s - 1e-3), for s = 1 and 2; the third has no
  // others.
  const std::vector<GaussianPair> pairs{pair_at(0, 1.0), pair_at(1, 4.0), pair_at(100, 0.0)};
  const CloudAnalyzerStructure found = cloudanalyzer_structure(pairs, 5);
  EXPECT_NEAR(found.awd_m, std::numbers::sqrt3 * (0.999 + 1.999) / 3.0, 1e-12);
  EXPECT_EQ(found.n_awd_voxels, 3U);
  EXPECT_EQ(found.n_scs_voxels, 2U);
  EXPECT_EQ(found.scs, 0.0) << "one other voxel has no spread";
  const CloudAnalyzerStructure zeros =
      cloudanalyzer_structure(std::vector<GaussianPair>{pair_at(0, 0.0), pair_at(1, 0.0)}, 5);
  EXPECT_EQ(zeros.n_scs_voxels, 2U) << "ours leaves such voxels out";
  EXPECT_EQ(zeros.scs, 0.0);
  EXPECT_TRUE(std::isnan(cloudanalyzer_structure({}, 5).awd_m));
}

TEST(CloudCompareDistance, HandComputed) {
  const CloudCompareDistance found = cloudcompare_distance(Doubles{1.0, 9.0});
  EXPECT_EQ(found.mean_m, 2.0);
  EXPECT_EQ(found.standard_deviation_m, 1.0);  // population: 1, not sqrt 2
  EXPECT_EQ(cloudcompare_distance(Doubles{0.25, 0.25, 0.25}).standard_deviation_m, 0.0);
}

TEST(CloudCompareDistance, StoresDistancesAsFloats) {
  EXPECT_EQ(cloudcompare_distance(Doubles{0.01}).mean_m, static_cast<double>(0.1f));
}

TEST(CloudCompareDistance, EqualsTheDefinition) {
  const Doubles sq_dist = random_squares(5000);
  double mean = 0.0, variance = 0.0;
  for (double sq : sq_dist) mean += std::sqrt(sq) / 5000.0;
  for (double sq : sq_dist) variance += (std::sqrt(sq) - mean) * (std::sqrt(sq) - mean) / 5000.0;
  const CloudCompareDistance found = cloudcompare_distance(sq_dist);
  EXPECT_NEAR(found.mean_m, mean, 3e-8);  // half a float digit of distances below 1 m
  EXPECT_NEAR(found.standard_deviation_m, std::sqrt(variance), 1e-7);
}

}  // namespace
}  // namespace cmap

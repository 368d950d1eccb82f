#include "cmap/peers/mapeval.hpp"

#include <cmath>
#include <numbers>

#include "peers/peers_testing.hpp"

namespace cmap {
namespace mapeval_test {

using test::diagonal;
using test::Doubles;
using test::kZero;

double mapeval_distance(const Gaussian& reference, const Gaussian& estimate) {
  return mapeval_wasserstein_distances(std::vector<GaussianPair>{{{1, 2, 3}, reference, estimate}}).front().distance_m;
}

/// n points of the covariance that MapEval gets after all its divisions by n - 1.
Gaussian mapeval_gaussian(std::uint64_t n, const Eigen::Vector3d& mean, const Eigen::Matrix3d& covariance) {
  const auto m = static_cast<double>(n - 1);
  return {n, mean, covariance * (n > 10 ? m * m * m : m)};
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
  const Doubles sq_dist = test::peer_squares(5000);
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

}  // namespace mapeval_test
}  // namespace cmap

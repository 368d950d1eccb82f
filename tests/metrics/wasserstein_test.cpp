#include "cmap/metrics/wasserstein.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <map>
#include <numbers>

#include "cmap/core/error.hpp"
#include "metrics/map_pairs.hpp"

namespace cmap {
namespace wasserstein_test {

Gaussian gaussian(const Eigen::Vector3d& mean, const Eigen::Matrix3d& covariance, std::uint64_t n = 101) {
  return {n, mean, covariance * static_cast<double>(n - 1)};
}

const Eigen::Vector3d kZero = Eigen::Vector3d::Zero();

Eigen::Matrix3d diagonal(double a, double b, double c) { return Eigen::Vector3d(a, b, c).asDiagonal(); }

double uniform(std::mt19937_64& random, double low, double high) { return low + (high - low) * test::uniform(random); }

Eigen::Vector3d random_vector(std::mt19937_64& random) {
  const double x = uniform(random, -1, 1), y = uniform(random, -1, 1), z = uniform(random, -1, 1);
  return {x, y, z};
}

Eigen::Matrix3d random_covariance(std::mt19937_64& random) {
  Eigen::Matrix3d root;
  for (int c = 0; c < 3; ++c) root.col(c) = random_vector(random);
  return root * root.transpose();
}

/// The trace of the root from the eigenvalues of the product, which is not symmetric: no matrix root at all.
double by_eigenvalues(const Gaussian& a, const Gaussian& b) {
  const Eigen::Matrix3d product = a.covariance() * b.covariance();
  const double root_trace = product.eigenvalues().real().cwiseMax(0.0).cwiseSqrt().sum();
  const double sq = (a.mean - b.mean).squaredNorm() + (a.covariance() + b.covariance()).trace() - 2.0 * root_trace;
  return std::sqrt(sq);
}

std::vector<GaussianPair> pairs_of(const test::Clouds& clouds, double voxel_m, std::uint64_t min_points) {
  return gaussian_pairs(clouds.pair(), voxel_m, min_points);
}

TEST(WassersteinDistance, OfEqualShapesIsTheDistanceOfTheMeans) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Matrix3d covariance = random_covariance(random);
    const Eigen::Vector3d m = random_vector(random);
    // W^2 is a difference of numbers of size tr S <= 9, good to 1e-15 of them.
    EXPECT_NEAR(wasserstein_distance(gaussian(kZero, covariance), gaussian(m, covariance)), m.norm(), 2e-14 / m.norm());
  }
}

TEST(WassersteinDistance, OfSpheresIsSqrt3TimesTheDifference) {
  for (const auto& [s1, s2] : {std::pair{0.5, 0.25}, {1.0, 1.001}, {0.0, 2.0}, {3.0, 0.1}}) {
    const double found = wasserstein_distance(gaussian(kZero, diagonal(s1 * s1, s1 * s1, s1 * s1)),
                                              gaussian(kZero, diagonal(s2 * s2, s2 * s2, s2 * s2)));
    // The smallest W^2 here is 3e-6 of traces of 6: rounding is 1e-15 x 6 / 3e-6 of it.
    EXPECT_NEAR_RELATIVE(found, std::numbers::sqrt3 * std::abs(s1 - s2), 2e-9);
  }
}

TEST(WassersteinDistance, OfCommutingShapesIsTheDistanceOfTheAxes) {
  const Gaussian a = gaussian({1, 2, 3}, diagonal(1, 4, 9));
  const Gaussian b = gaussian({1, 2, 5}, diagonal(4, 4, 0.25));
  EXPECT_DOUBLE_EQ(wasserstein_distance(a, b), std::sqrt(4 + 1 + 0 + 6.25));
}

TEST(WassersteinDistance, OfLinesDependsOnTheirAngle) {
  // Rank one: tr root = a b |cos|.
  for (double angle : {0.0, 0.3, 1.0, std::numbers::pi / 2}) {
    const Eigen::Vector3d u(1, 0, 0), v(std::cos(angle), std::sin(angle), 0);
    const double a = 2.0, b = 0.5;
    const double found =
        wasserstein_distance(gaussian(kZero, a * a * u * u.transpose()), gaussian(kZero, b * b * v * v.transpose()));
    // Eigenvalues of 1e-16 where there should be 0 have roots of 1e-8.
    EXPECT_NEAR(found, std::sqrt(a * a + b * b - 2.0 * a * b * std::cos(angle)), 1e-7);
  }
}

TEST(WassersteinDistance, OfPlanesThatDoNotCommute) {
  // For 2 x 2: tr (S1^1/2 S2 S1^1/2)^1/2 = sqrt(tr S1 S2 + 2 sqrt(det S1 det S2)).
  Eigen::Matrix3d s1 = diagonal(1.0, 0.25, 0.0);
  Eigen::Matrix3d s2 = diagonal(0.5, 0.5, 0.0);
  s2(0, 1) = s2(1, 0) = 0.25;
  const double root_trace = std::sqrt(0.5 + 0.125 + 2.0 * std::sqrt(0.25 * 0.1875));
  EXPECT_NEAR(wasserstein_distance(gaussian(kZero, s1), gaussian(kZero, s2)), std::sqrt(2.25 - 2.0 * root_trace),
              1e-12);
}

TEST(WassersteinDistance, OfAShapeAndItselfIsExactlyZero) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 200; ++i) {
    const Gaussian a = gaussian(random_vector(random), random_covariance(random));
    EXPECT_EQ(wasserstein_distance(a, a), 0.0);
  }
  const Gaussian flat = gaussian(kZero, diagonal(1, 2, 0));
  EXPECT_EQ(wasserstein_distance(flat, flat), 0.0);
  const Gaussian point = gaussian(kZero, diagonal(0, 0, 0));
  EXPECT_EQ(wasserstein_distance(point, point), 0.0);
}

TEST(WassersteinDistance, TheDenominatorIsNMinusOne) {
  // One scatter, 2 and 5 points: covariances 4 I and I.
  const Gaussian two{2, kZero, 4.0 * Eigen::Matrix3d::Identity()};
  const Gaussian five{5, kZero, 4.0 * Eigen::Matrix3d::Identity()};
  EXPECT_DOUBLE_EQ(wasserstein_distance(two, five), std::numbers::sqrt3);
}

TEST(WassersteinDistance, EqualsTheEigenvaluesOfTheProduct) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 1000; ++i) {
    const Gaussian a = gaussian(random_vector(random), random_covariance(random));
    const Gaussian b = gaussian(random_vector(random), random_covariance(random));
    // The oracle loses half the digits of a small eigenvalue to the root.
    EXPECT_NEAR_RELATIVE(wasserstein_distance(a, b), by_eigenvalues(a, b), 1e-6);
  }
}

TEST(WassersteinDistance, IsAMetric) {
  std::mt19937_64 random(4);
  for (int i = 0; i < 500; ++i) {
    const Gaussian a = gaussian(random_vector(random), random_covariance(random));
    const Gaussian b = gaussian(random_vector(random), random_covariance(random));
    const Gaussian c = gaussian(random_vector(random), random_covariance(random));
    EXPECT_NEAR_RELATIVE(wasserstein_distance(a, b), wasserstein_distance(b, a), 1e-12);
    EXPECT_LE(wasserstein_distance(a, c), wasserstein_distance(a, b) + wasserstein_distance(b, c));
    EXPECT_GE(wasserstein_distance(a, b), (a.mean - b.mean).norm());
  }
}

TEST(WassersteinDistance, IsInvariantUnderRotationAndScales) {
  std::mt19937_64 random(5);
  const Eigen::Matrix3d R = test::rigid_motion().topLeftCorner<3, 3>();
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d m = random_vector(random);
    const Eigen::Matrix3d s1 = random_covariance(random), s2 = random_covariance(random);
    const double expected = wasserstein_distance(gaussian(kZero, s1), gaussian(m, s2));
    EXPECT_NEAR_RELATIVE(
        wasserstein_distance(gaussian(kZero, R * s1 * R.transpose()), gaussian(R * m, R * s2 * R.transpose())),
        expected, 1e-12);
    EXPECT_NEAR_RELATIVE(wasserstein_distance(gaussian(kZero, 9 * s1), gaussian(3 * m, 9 * s2)), 3 * expected, 1e-12);
  }
}

TEST(GaussianPairs, HandComputed) {
  // Two points each in the voxels [-4, 0) and [0, 4); of the voxel [8, 12) the estimate has but one.
  const PointCloud reference = test::cloud_of({{1, 1, 1}, {3, 1, 1}, {-1, 1, 1}, {-1, 3, 1}, {9, 1, 1}, {10, 1, 1}});
  const PointCloud estimate = test::cloud_of({{1, 2, 1}, {3, 2, 1}, {-1, 1, 1}, {-1, 1, 3}, {9, 1, 1}, {50, 1, 1}});
  const std::vector<GaussianPair> pairs = pairs_of({reference, estimate}, 4.0, 2);
  ASSERT_EQ(pairs.size(), 2U);
  EXPECT_EQ(pairs[0].index, (VoxelIndex{-1, 0, 0}));
  EXPECT_EQ(pairs[1].index, (VoxelIndex{0, 0, 0}));
  EXPECT_EQ(pairs[1].reference.n, 2U);
  EXPECT_EQ(pairs[1].reference.mean, Eigen::Vector3d(2, 1, 1));  // from the corner (0, 0, 0)
  EXPECT_EQ(pairs[1].estimate.mean, Eigen::Vector3d(2, 2, 1));
  EXPECT_EQ(pairs[0].reference.mean, Eigen::Vector3d(3, 2, 1));  // from (-4, 0, 0)
  EXPECT_EQ(pairs[1].reference.scatter, diagonal(2, 0, 0));
  EXPECT_EQ(pairs[0].reference.scatter, diagonal(0, 2, 0));
  EXPECT_EQ(pairs[0].estimate.scatter, diagonal(0, 0, 2));
  EXPECT_DOUBLE_EQ(wasserstein_distance(pairs[1].reference, pairs[1].estimate), 1.0);
  EXPECT_EQ(pairs_of({reference, estimate}, 4.0, 0).size(), 2U);  // never fewer than 2 points
  EXPECT_TRUE(pairs_of({reference, estimate}, 4.0, 3).empty());
}

/// The points of every voxel, in the world frame.
std::map<VoxelIndex, std::vector<Eigen::Vector3d>> voxels_of(const PointCloud& cloud, double voxel_m) {
  std::map<VoxelIndex, std::vector<Eigen::Vector3d>> voxels;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d v = (cloud.world(i) / voxel_m).array().floor();
    voxels[{static_cast<std::int64_t>(v.x()), static_cast<std::int64_t>(v.y()), static_cast<std::int64_t>(v.z())}]
        .push_back(cloud.world(i));
  }
  return voxels;
}

void expect_is_gaussian_of(const Gaussian& found, const std::vector<Eigen::Vector3d>& points,
                           const Eigen::Vector3d& corner) {
  ASSERT_EQ(found.n, points.size());
  Eigen::Vector3d mean = kZero;
  for (const auto& p : points) mean += p / static_cast<double>(points.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const auto& p : points) scatter += (p - mean) * (p - mean).transpose();
  // Coordinates of up to 20 m in sums of hundreds.
  EXPECT_LT((found.mean + corner - mean).norm(), 1e-12);
  EXPECT_LT((found.scatter - scatter).norm(), 1e-12 * (1.0 + scatter.norm()));
}

TEST(GaussianPairs, EqualTheDefinition) {
  const test::Clouds clouds = test::two_sheets();
  const double voxel_m = 3.0;
  auto in_reference = voxels_of(clouds.reference, voxel_m);
  auto in_estimate = voxels_of(clouds.estimate, voxel_m);
  const std::vector<GaussianPair> pairs = pairs_of(clouds, voxel_m, 50);
  std::size_t n_expected = 0;
  for (const auto& [index, points] : in_reference)
    n_expected += points.size() >= 50 && in_estimate[index].size() >= 50 ? 1 : 0;
  ASSERT_EQ(pairs.size(), n_expected);
  ASSERT_GT(n_expected, 10U);
  EXPECT_TRUE(std::ranges::is_sorted(pairs, {}, &GaussianPair::index));
  for (const GaussianPair& pair : pairs) {
    const Eigen::Vector3d index(static_cast<double>(pair.index[0]), static_cast<double>(pair.index[1]),
                                static_cast<double>(pair.index[2]));
    const Eigen::Vector3d corner = index * voxel_m;
    expect_is_gaussian_of(pair.reference, in_reference[pair.index], corner);
    expect_is_gaussian_of(pair.estimate, in_estimate[pair.index], corner);
  }
}

TEST(GaussianPairs, RefuseVoxelsTooSmallToCount) { EXPECT_THROW(pairs_of(test::two_sheets(), 1e-9, 2), UsageError); }

}  // namespace wasserstein_test
}  // namespace cmap

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "metrics/measured.hpp"

namespace cmap {
namespace mean_map_entropy_test {

const double kEntropyOfUnitGaussian = 1.5 * std::log(2.0 * std::numbers::pi * std::numbers::e);

struct Entropy {
  double value;
  std::uint64_t n, n_left_out, n_flat;
};

Entropy entropy_of(const Record& record) {
  const auto count = [&](const char* name) { return static_cast<std::uint64_t>(test::number(record, name)); };
  return {*record.value, count("n"), count("n_left_out"), count("n_flat")};
}

Entropy entropy(const PointCloud& cloud, double radius_m, std::uint64_t min_neighbors) {
  MetricOptions options;
  options.mme_radius_m = radius_m;
  options.mme_min_neighbors = min_neighbors;
  return entropy_of(test::measured(catalog::mean_map_entropy, cloud, options));
}

/// Of these neighborhoods in place of a map's.
Entropy entropy(const NeighborhoodShape& shape, std::uint64_t min_neighbors) {
  const IndexedMap map(test::cloud_of(std::vector<Eigen::Vector3f>(shape.n_neighbors.size(), {0, 0, 0})));
  MetricOptions options;
  options.mme_min_neighbors = min_neighbors;
  MetricInputs inputs(options, map);
  inputs.neighborhoods.estimate = shape;
  std::vector<Warning> warnings;
  return entropy_of(measure(catalog::mean_map_entropy, inputs, warnings));
}

/// A map with volume everywhere.
PointCloud block() { return test::uniform_cloud(2000, 1, 3.0f); }

constexpr double kRadius_m = 0.5;

void expect_same(const Entropy& found, const Entropy& expected, double tolerance) {
  EXPECT_EQ(found.n, expected.n);
  EXPECT_EQ(found.n_left_out, expected.n_left_out);
  EXPECT_NEAR(found.value, expected.value, tolerance);
}

TEST(MeanMapEntropy, HandComputed) {
  const double e = std::numbers::e;
  const NeighborhoodShape shape{{10, 11, 9, 12, 13}, {1.0, e * e, 1.0, 0.0, std::nan("")}, {0, 0, 0, 1, 0}};
  // The third has too few neighbors, the fourth is flat, the fifth has no covariance: 1/2 (0 + 2) / 2 is left.
  const Entropy found = entropy(shape, 10);
  EXPECT_EQ(found.n, 2U);
  EXPECT_EQ(found.n_left_out, 2U);
  EXPECT_EQ(found.n_flat, 1U);
  EXPECT_DOUBLE_EQ(found.value, kEntropyOfUnitGaussian + 0.5);
}

TEST(MeanMapEntropy, OfAnOctahedron) {
  // Only the center has six neighbors within 1.25; their covariance is 2/5 I.
  const PointCloud cloud =
      test::cloud_of({{0, 0, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}});
  const Entropy found = entropy(cloud, 1.25, 6);
  EXPECT_EQ(found.n, 1U);
  EXPECT_EQ(found.n_left_out, 6U);
  EXPECT_DOUBLE_EQ(found.value, kEntropyOfUnitGaussian + 0.5 * std::log(0.064));
}

TEST(MeanMapEntropy, NoPointQualifies) {
  for (const PointCloud& cloud : {test::cloud_of({{1, 2, 3}}), test::repeated(test::cloud_of({{1, 2, 3}}), 50)}) {
    const Entropy none = entropy(cloud, 0.1, 10);
    EXPECT_TRUE(std::isnan(none.value));
    EXPECT_EQ(none.n, 0U);
    EXPECT_EQ(none.n_left_out + none.n_flat, cloud.size());
  }
  EXPECT_EQ(entropy(test::grid_cloud(1), 5.0, 2).n, 0U);  // three points on a line
}

TEST(MeanMapEntropy, EqualsTheDefinition) {
  const PointCloud cloud = block();
  double sum = 0.0;
  std::uint64_t n = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    std::vector<Eigen::Vector3d> neighbors;
    for (std::size_t j = 0; j < cloud.size(); ++j) {
      if (j != i && (cloud.world(j) - cloud.world(i)).norm() <= kRadius_m) neighbors.push_back(cloud.world(j));
    }
    if (neighbors.size() < 10) continue;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const auto& p : neighbors) mean += p / static_cast<double>(neighbors.size());
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (const auto& p : neighbors)
      covariance += (p - mean) * (p - mean).transpose() / static_cast<double>(neighbors.size() - 1);
    sum += 0.5 * std::log(std::pow(2.0 * std::numbers::pi * std::numbers::e, 3.0) * covariance.determinant());
    ++n;
  }
  const Entropy found = entropy(cloud, kRadius_m, 10);
  EXPECT_EQ(found.n, n);
  EXPECT_LT(found.n, cloud.size());
  // Determinants of ten and more points in a ball keep all but a few of their sixteen digits.
  EXPECT_NEAR(found.value, sum / static_cast<double>(n), 1e-11);
}

TEST(MeanMapEntropy, IsInvariantUnderMotionPermutationAndTranslation) {
  const PointCloud cloud = block();
  const Entropy expected = entropy(cloud, kRadius_m, 8);
  expect_same(entropy(test::permuted(cloud, 3), kRadius_m, 8), expected, 0.0);
  expect_same(entropy(transformed(cloud, test::translation({1e6, -1e6, 1e6})), kRadius_m, 8), expected,
              test::kSummation);
  // Coordinates below 16 m are rounded to 5e-7 m: 1e-6 of the radius, in each of three axes.
  expect_same(entropy(transformed(cloud, test::rigid_motion()), kRadius_m, 8), expected, 1e-5);
}

TEST(MeanMapEntropy, GrowsByThreeTimesTheLogarithmOfTheScale) {
  const Entropy expected = entropy(block(), kRadius_m, 8);
  const Entropy found = entropy(transformed(block(), test::scaling(4.0)), 4.0 * kRadius_m, 8);
  EXPECT_EQ(found.n, expected.n);
  EXPECT_NEAR(found.value, expected.value + 3.0 * std::log(4.0), 1e-12);
}

TEST(MeanMapEntropy, MorePointsQualifyWithALargerRadiusAndFewerWithMoreNeighborsAsked) {
  const PointCloud cloud = block();
  std::uint64_t before = 0;
  for (double radius_m : {0.1, 0.2, 0.3, 0.5, 1.0}) {
    const Entropy found = entropy(cloud, radius_m, 10);
    EXPECT_GE(found.n, before);
    EXPECT_EQ(found.n + found.n_left_out + found.n_flat, cloud.size());
    before = found.n;
  }
  EXPECT_EQ(before, cloud.size());
  EXPECT_LT(entropy(cloud, kRadius_m, 40).n, entropy(cloud, kRadius_m, 10).n);
}

/// A lattice in the plane z = 0.
PointCloud plane() {
  PointCloud cloud;
  for (int i = 0; i < 30; ++i) {
    for (int j = 0; j < 30; ++j) {
      cloud.positions.push_back({0.1f * static_cast<float>(i), 0.1f * static_cast<float>(j), 0});
    }
  }
  return cloud;
}

Eigen::Matrix4d turned(double angle_rad, const Eigen::Vector3d& axis) {
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T.topLeftCorner<3, 3>() = Eigen::AngleAxisd(angle_rad, axis.normalized()).toRotationMatrix();
  return T;
}

TEST(MeanMapEntropy, AnExactPlaneHasNoneWhicheverWayItIsTurned) {
  for (const Eigen::Vector3d& axis : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(-3, 1, 0)}) {
    for (double angle_rad : {0.0, 0.01, 0.7, 1.5707963267948966, 2.3}) {
      for (const Eigen::Vector3d& shift : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(7, -31, 2)}) {
        PointCloud cloud = transformed(plane(), test::translation(shift) * turned(angle_rad, axis));
        const Entropy found = entropy(cloud, 0.25, 5);
        EXPECT_EQ(found.n, 0U) << angle_rad << " about " << axis.transpose();
        EXPECT_EQ(found.n_left_out, 0U);
        EXPECT_EQ(found.n_flat, 900U);
        EXPECT_TRUE(std::isnan(found.value));
      }
    }
  }
}

TEST(MeanMapEntropy, WhatIsThickerThanTheRoundingHasOne) {
  std::mt19937_64 random(3);
  PointCloud cloud = plane();
  for (Eigen::Vector3f& p : cloud.positions) p.z() = 1e-4f * static_cast<float>(test::uniform(random));
  // Coordinates below 4 m are held to 2.4e-7 m; 1e-4 / sqrt 12 = 2.9e-5 is a hundred times as much.
  EXPECT_EQ(entropy(cloud, 0.25, 5).n, 900U);
  // The same far away, or from a file of millimeters, would be rounding.
  EXPECT_EQ(entropy(transformed(cloud, test::rigid_motion()), 0.25, 5).n, 900U);
  const Bvh index(sort_points(cloud));
  EXPECT_EQ(entropy(neighborhood_shapes(index, 0.25, 0.001), 5).n_flat, 900U);
  EXPECT_EQ(entropy(neighborhood_shapes(index, 0.25, 1e-7), 5).n, 900U);
}

TEST(MeanMapEntropy, IsLowerForASharperMap) {
  PointCloud thin = test::uniform_cloud(3000, 2, 3.0f);
  PointCloud thick = thin;
  for (Eigen::Vector3f& p : thin.positions) p.z() *= 0.01f;
  for (Eigen::Vector3f& p : thick.positions) p.z() *= 0.05f;
  EXPECT_LT(entropy(thin, kRadius_m, 10).value,
            entropy(thick, kRadius_m, 10).value - 1.0);  // ln 5 = 1.6, at infinite radius
}

}  // namespace mean_map_entropy_test
}  // namespace cmap

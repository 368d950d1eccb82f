#include "cmap/colorize/exposure.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace cmap {
namespace exposure_test {

/// Each point is in four images one after the other; a share of the sights is of something else.
Observations chain(const Eigen::Matrix3Xd& gains, double outliers) {
  constexpr std::size_t kPoints = 20'000;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> level(30, 120), share(0, 1);
  Observations observations(kPoints, 8);
  for (std::size_t p = 0; p < kPoints; ++p) {
    const auto first = static_cast<Eigen::Index>(p % static_cast<std::size_t>(gains.cols() - 3));
    const Eigen::Vector3d color(level(random), level(random), level(random));
    for (Eigen::Index i = first; i < first + 4; ++i) {
      Eigen::Vector3d seen = gains.col(i).cwiseProduct(color);
      if (share(random) < outliers) seen = {200, 20, 90};
      const auto u8 = [&](int c) { return static_cast<std::uint8_t>(std::lround(std::min(255.0, seen[c]))); };
      observations.add(p, {1.0f, static_cast<std::uint32_t>(i), {u8(0), u8(1), u8(2)}});
    }
  }
  return observations;
}

Eigen::Matrix3Xd wandering_gains(Eigen::Index n, double of_channels) {
  Eigen::Matrix3Xd gains(3, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto t = static_cast<double>(i);
    for (int c = 0; c < 3; ++c) gains(c, i) = std::exp(0.3 * std::sin(0.7 * t) + of_channels * std::cos(t + 2.0 * c));
  }
  return gains;
}

/// Up to one factor for all.
double largest_error(const Eigen::Matrix3Xd& found, const Eigen::Matrix3Xd& truth) {
  double largest = 0.0;
  for (int c = 0; c < 3; ++c) {
    const Eigen::ArrayXd ratio = (found.row(c).array() / truth.row(c).array()).log();
    largest = std::max(largest, ratio.maxCoeff() - ratio.minCoeff());
  }
  return largest;
}

TEST(ExposureGains, OfImagesAreRecoveredInSpiteOfOutliers) {
  const Eigen::Matrix3Xd truth = wandering_gains(25, 0.0);
  const Eigen::Matrix3Xd found = exposure_gains_of(chain(truth, 0.05), 25, {.model = ExposureModel::kGain});
  EXPECT_LT(largest_error(found, truth), 0.01);
  EXPECT_EQ((found.row(0) - found.row(2)).norm(), 0.0);
  std::vector<double> sorted;
  for (Eigen::Index i = 0; i < 25; ++i) sorted.push_back(found(0, i));
  std::ranges::sort(sorted);
  EXPECT_NEAR(sorted[12], 1.0, 1e-12) << "the middle image keeps its exposure";
}

TEST(ExposureGains, OfChannelsAreRecovered) {
  const Eigen::Matrix3Xd truth = wandering_gains(25, 0.1);
  const Observations seen = chain(truth, 0.05);
  EXPECT_LT(largest_error(exposure_gains_of(seen, 25, {.model = ExposureModel::kChannels}), truth), 0.015);
  EXPECT_GT(largest_error(exposure_gains_of(seen, 25, {}), truth), 0.1) << "one gain cannot say it";
}

TEST(ExposureGains, AreOneWithoutSharedPointsOrWhenOff) {
  Observations alone(100, 4);
  for (std::size_t p = 0; p < 100; ++p) alone.add(p, {1.0f, static_cast<std::uint32_t>(p % 3), {100, 90, 80}});
  EXPECT_EQ(exposure_gains_of(alone, 3, {}), Eigen::Matrix3Xd::Ones(3, 3));
  const Observations chained = chain(wandering_gains(6, 0.0), 0.0);
  EXPECT_EQ(exposure_gains_of(chained, 6, {.model = ExposureModel::kNone}), Eigen::Matrix3Xd::Ones(3, 6));
}

TEST(ExposureGains, LeaveOutLevelsThatWereCutOff) {
  Observations observations(200, 4);
  for (std::size_t p = 0; p < 200; ++p) {
    const bool cut_off = p % 2 == 0;
    observations.add(p, {1.0f, 0, cut_off ? Rgb8{255, 255, 255} : Rgb8{100, 100, 100}});
    observations.add(p, {1.0f, 1, cut_off ? Rgb8{150, 150, 150} : Rgb8{50, 50, 50}});
  }
  const Eigen::Matrix3Xd found = exposure_gains_of(observations, 3, {});
  EXPECT_NEAR(found(0, 0) / found(0, 1), 2.0, 0.02);
}

}  // namespace exposure_test
}  // namespace cmap

#include "loops/ring_descriptor.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "cmap/core/random_hash.hpp"

namespace cmap {
namespace {

constexpr double kPi = std::numbers::pi;

/// Walls about a place: segments with posts of 5 m, turned and shifted.
PointCloud walls(std::uint64_t seed, double yaw_rad = 0.0, const Eigen::Vector2d& shift_m = {0.0, 0.0}) {
  const auto random = [&](std::uint64_t i) { return static_cast<double>(random_below(1000, i, seed)) / 1000.0 - 0.5; };
  const Eigen::Rotation2Dd turn(yaw_rad);
  PointCloud cloud;
  for (std::uint64_t wall = 0; wall < 12; ++wall) {
    const Eigen::Vector2d middle(60.0 * random(4 * wall), 60.0 * random(4 * wall + 1));
    const double heading = 2.0 * kPi * random(4 * wall + 2), length_m = 12.0 + 16.0 * random(4 * wall + 3);
    for (double along = -0.5 * length_m; along < 0.5 * length_m; along += 0.2) {
      const Eigen::Vector2d p =
          turn * (middle + along * Eigen::Vector2d(std::cos(heading), std::sin(heading))) + shift_m;
      for (double z = 0.0; z < 5.0; z += 0.5) cloud.positions.push_back(Eigen::Vector3d(p.x(), p.y(), z).cast<float>());
    }
  }
  return cloud;
}

BirdsEye view_of_walls(const PointCloud& cloud) { return birds_eye(cloud, 0.0, 60.0); }

TEST(Radon, IsWhatSummingEveryCellGives) {
  const BirdsEye view = view_of_walls(walls(1));
  const BirdsEyeImage image = image_of(view);
  const Sinogram fast = radon(view);
  Sinogram direct = Sinogram::Zero(fast.rows(), fast.cols());
  for (int a = 0; a < kRingAngles; ++a) {
    for (int y = 0; y < image.side; ++y) {
      for (int x = 0; x < image.side; ++x) {
        const double r = (x + 0.5 - image.side / 2) * std::cos(kPi * a / kRingAngles) +
                         (y + 0.5 - image.side / 2) * std::sin(kPi * a / kRingAngles) +
                         static_cast<double>(fast.cols() / 2);
        for (Eigen::Index c = static_cast<Eigen::Index>(r) - 1; c <= static_cast<Eigen::Index>(r) + 2; ++c) {
          const double share = 1.0 - std::abs(r - static_cast<double>(c));
          if (share > 0.0) direct(a, c) += static_cast<float>(share) * image.at(x, y);
        }
      }
    }
  }
  EXPECT_LT((fast - direct).cwiseAbs().maxCoeff(), 1e-3F * fast.maxCoeff());
}

TEST(Radon, EveryAngleSumsTheWholeView) {
  const BirdsEye view = view_of_walls(walls(2));
  double sum = 0.0;
  for (const BirdsEye::Cell& cell : view.cells) sum += static_cast<double>(cell.value);
  const Sinogram sinogram = radon(view);
  for (int a = 0; a < kRingAngles; ++a) EXPECT_NEAR(static_cast<double>(sinogram.row(a).sum()), sum, 1e-3 * sum);
}

TEST(Radon, AWallIsOnePeak) {
  PointCloud wall;  // x = 10.5, along y
  for (double y = -20.0; y < 20.0; y += 0.25) {
    for (double z = 0.0; z < 5.0; z += 0.5) wall.positions.push_back(Eigen::Vector3d(10.5, y, z).cast<float>());
  }
  const Sinogram sinogram = radon(view_of_walls(wall));
  Eigen::Index angle = 0, offset = 0;
  sinogram.maxCoeff(&angle, &offset);
  EXPECT_LE(std::min(angle, kRingAngles - angle), 1);
  EXPECT_NEAR(static_cast<double>(offset - sinogram.cols() / 2), 10.5, 0.51);
}

TEST(Ring, DoesNotChangeWhereTheViewIsShifted) {
  const Sinogram here = ring_of(radon(view_of_walls(walls(3)))),
                 there = ring_of(radon(view_of_walls(walls(3, 0.0, {7.0, -5.0}))));
  EXPECT_GT(here.cwiseProduct(there).sum(), 0.98F);  // by whole cells: only the split of a cell's value differs
}

TEST(Ring, OtherPlacesAreUnlike) {
  const RingDescriptor one = ring_descriptor(view_of_walls(walls(4)));
  EXPECT_NEAR(best_turn(one, one).similarity, 1.0, 1e-4);
  EXPECT_GT(best_turn(one, ring_descriptor(view_of_walls(walls(4, 0.7, {4.3, 2.2})))).similarity, 0.75);
  for (std::uint64_t seed = 5; seed < 12; ++seed) {
    EXPECT_LT(best_turn(one, ring_descriptor(view_of_walls(walls(seed)))).similarity, 0.6) << seed;
  }
}

TEST(Ring, FindsTheTurnButFor180Degrees) {
  const RingDescriptor target = ring_descriptor(view_of_walls(walls(6)));
  for (const double yaw_rad : {0.0, 0.4, 1.3, 2.5, 3.6, 5.9}) {
    // The source turned by -yaw: it lies on the target turned by yaw.
    const RingMatch match = best_turn(ring_descriptor(view_of_walls(walls(6, -yaw_rad, {3.0, 1.0}))), target);
    EXPECT_LT(std::abs(std::remainder(match.yaw_rad - yaw_rad, kPi)), 2.0 * kPi / 180.0) << yaw_rad;
    EXPECT_GE(match.yaw_rad, 0.0);
    EXPECT_LT(match.yaw_rad, kPi);
  }
}

TEST(Ring, CorrelationIsWhatSummingEveryShiftGives) {
  const BirdsEye one = view_of_walls(walls(8)), other = view_of_walls(walls(8, 0.9, {2.0, 6.0}));
  const Sinogram source = ring_of(radon(one)), target = ring_of(radon(other));
  double best = -2.0;
  int best_shift = 0;
  for (int shift = 0; shift < kRingAngles; ++shift) {
    double sum = 0.0;
    for (int a = 0; a < kRingAngles; ++a) {
      sum += static_cast<double>(source.row(a).dot(target.row((a + shift) % kRingAngles)));
    }
    if (sum > best) best = sum, best_shift = shift;
  }
  const RingMatch match = best_turn(ring_descriptor(one), ring_descriptor(other));
  EXPECT_NEAR(match.similarity, best, 1e-4);
  EXPECT_NEAR(match.yaw_rad, kPi * best_shift / kRingAngles, 1e-9);
}

TEST(Ring, AnEmptyViewIsLikeNothing) {
  const RingDescriptor empty = ring_descriptor(view_of_walls(PointCloud{}));
  EXPECT_EQ(best_turn(empty, ring_descriptor(view_of_walls(walls(9)))).similarity, 0.0);
}

}  // namespace
}  // namespace cmap

#include "loops/shift_search.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "cmap/core/random_hash.hpp"

namespace cmap {
namespace {

/// Posts of 4 m at random places, turned and shifted; every `period_m` along x once more, where that is above 0.
PointCloud posts(std::uint64_t seed, double yaw_rad = 0.0, const Eigen::Vector2d& shift_m = {0.0, 0.0},
                 double period_m = 0.0) {
  PointCloud cloud;
  const Eigen::Rotation2Dd turn(yaw_rad);
  for (std::uint64_t i = 0; i < 60; ++i) {
    const auto random = [&](std::uint64_t k) {
      return static_cast<double>(random_below(1000, k, seed)) / 1000.0 - 0.5;
    };
    const Eigen::Vector2d post(70.0 * random(2 * i), 70.0 * random(2 * i + 1));
    for (int n = period_m > 0.0 ? -1 : 0; n <= (period_m > 0.0 ? 1 : 0); ++n) {
      const Eigen::Vector2d p = turn * (post + n * Eigen::Vector2d(period_m, 0.0)) + shift_m;
      for (double z = 0.0; z < 4.0; z += 0.4) cloud.positions.push_back(Eigen::Vector3d(p.x(), p.y(), z).cast<float>());
    }
  }
  return cloud;
}

BirdsEye view_of_posts(const PointCloud& cloud) { return birds_eye(cloud, 0.0, 60.0); }

TEST(BirdsEye, CountsSlicesAboveTheGround) {
  PointCloud cloud;  // cells and slices of 1 m, from half a slice up
  for (const float z : {10.2F, 10.7F, 11.2F, 12.9F}) cloud.positions.push_back({3.5F, -2.5F, z});
  cloud.positions.push_back({-70.0F, 0.0F, 12.0F});
  const BirdsEye view = birds_eye(cloud, 10.0, 60.0);
  ASSERT_EQ(view.cells.size(), 1U);
  EXPECT_TRUE(view.cells[0].center.isApprox(Eigen::Vector2f(3.5F, -2.5F)));
  EXPECT_FLOAT_EQ(view.cells[0].value, 0.2F);  // 10.5..11.5 and 12.5..13.5
}

TEST(BirdsEye, ACeilingIsFaintAndAWallBright) {
  PointCloud cloud;
  for (float z = 0.0F; z < 8.0F; z += 0.25F) cloud.positions.push_back({5.5F, 0.5F, z});
  for (float x = -9.5F; x < 0.0F; x += 1.0F) cloud.positions.push_back({x, 0.5F, 8.0F});
  for (const BirdsEye::Cell& cell : view_of_posts(cloud).cells) {
    EXPECT_FLOAT_EQ(cell.value, cell.center.x() > 0.0F ? 0.8F : 0.1F);
  }
}

TEST(ShiftSearch, IsWhatSummingEveryShiftGives) {
  const BirdsEye source = view_of_posts(posts(1)), target_view = view_of_posts(posts(1, 0.0, {4.0, -3.0}));
  const BirdsEyeImage from = image_of(source), target = image_of(target_view);
  double best = -1.0;
  Eigen::Vector2i best_shift(0, 0);
  for (int dy = -8; dy <= 8; ++dy) {
    for (int dx = -8; dx <= 8; ++dx) {
      double sum = 0.0;
      for (int y = 0; y < from.side; ++y) {
        for (int x = 0; x < from.side; ++x) sum += static_cast<double>(from.at(x, y) * target.at(x + dx, y + dy));
      }
      if (sum > best) best = sum, best_shift = {dx, dy};
    }
  }
  double sq_from = 0.0, sq_target = 0.0;
  for (const float v : from.values) sq_from += static_cast<double>(v * v);
  for (const float v : target.values) sq_target += static_cast<double>(v * v);
  const PlanarPose found = best_shifts(source, target, 0.0, {0.0, 0.0}, 8.0).front();
  EXPECT_NEAR(found.score, best / std::sqrt(sq_from * sq_target), 1e-5);
  EXPECT_LE((found.shift_m - best_shift.cast<double>()).cwiseAbs().maxCoeff(), 0.5);
  EXPECT_EQ(best_shift, Eigen::Vector2i(4, -3));
}

TEST(ShiftSearch, FindsTurnAndShift) {
  const BirdsEyeImage target = image_of(view_of_posts(posts(2)));
  for (const double yaw_rad : {0.3, 2.0, -2.8}) {
    // x_target = R(yaw) x_source + shift
    const Eigen::Vector2d shift(6.0, -9.0);
    const BirdsEye source = view_of_posts(posts(2, -yaw_rad, -(Eigen::Rotation2Dd(-yaw_rad) * shift)));
    const std::vector<double> yaws{yaw_rad + std::numbers::pi, yaw_rad};
    const PlanarPose found = best_planar_poses(source, target, yaws, {0.0, 0.0}, 12.0).front();
    EXPECT_EQ(found.yaw_rad, yaw_rad);
    EXPECT_LT((found.shift_m - shift).norm(), 1.0) << yaw_rad;
    EXPECT_GT(found.score, 0.4);
  }
}

TEST(ShiftSearch, TellsTheNextBestOfWhatRepeats) {
  const BirdsEye source = view_of_posts(posts(3, 0.0, {0.0, 0.0}, 7.0));
  const std::vector<PlanarPose> found = best_shifts(source, image_of(source), 0.0, {0.0, 0.0}, 12.0);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_LT(found[0].shift_m.norm(), 0.5);
  EXPECT_NEAR(std::abs(found[1].shift_m.x()), 7.0, 0.6);
  EXPECT_NEAR(found[1].shift_m.y(), 0.0, 0.6);
  EXPECT_LT(found[1].score, found[0].score);
}

TEST(ShiftSearch, AnEmptyViewFitsNowhere) {
  const BirdsEye empty = view_of_posts(PointCloud{});
  EXPECT_EQ(best_shifts(empty, image_of(view_of_posts(posts(4))), 0.1, {1.0, 2.0}, 5.0).front().score, 0.0);
  EXPECT_EQ(best_shifts(view_of_posts(posts(4)), image_of(empty), 0.1, {1.0, 2.0}, 5.0).front().score, 0.0);
}

}  // namespace
}  // namespace cmap

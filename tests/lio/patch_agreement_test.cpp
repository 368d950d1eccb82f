#include "loops/patch_agreement.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "cmap/core/random_hash.hpp"
#include "cmap/geometry/rotation.hpp"

namespace cmap {
namespace {

/// Ground of 40 m, whole columns of the grid, with or without houses of 6 m at random places on it, a point every 0.2
/// m, 1 cm of noise.
PointCloud block(std::uint64_t seed, int n_houses) {
  PointCloud cloud;
  std::uint64_t n = 0;
  const auto random = [&] { return static_cast<double>(random_below(10'000, n++, seed)) / 10'000.0 - 0.5; };
  const auto add = [&](double x, double y, double z) {
    cloud.positions.push_back(
        Eigen::Vector3d(x + 0.02 * random(), y + 0.02 * random(), z + 0.02 * random()).cast<float>());
  };
  for (double x = -19.8; x < 19.9; x += 0.2) {
    for (double y = -19.8; y < 19.9; y += 0.2) add(x, y, 0.0);
  }
  for (int house = 0; house < n_houses; ++house) {
    const double x = 30.0 * random(), y = 30.0 * random(), side = 5.0 + 4.0 * random();
    for (double along = 0.0; along < side; along += 0.2) {
      for (double z = 0.0; z < 6.0; z += 0.2) {
        add(x + along, y, z);
        add(x, y + along, z);
      }
    }
  }
  return cloud;
}

Eigen::Isometry3d moved_by(const Eigen::Vector3d& shift, const Eigen::Vector3d& turn_rad = Eigen::Vector3d::Zero()) {
  Eigen::Isometry3d T(rotation_from(turn_rad));
  T.pretranslate(shift);
  return T;
}

TEST(PlaneGrid, FindsPlanesAndLeavesOutWhatIsNone) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 25; ++i) points.emplace_back(0.2 * (i % 5), 0.2 * (i / 5), i % 2 == 0 ? 0.01 : -0.01);
  const auto plane = plane_of(points, 1.0);
  ASSERT_TRUE(plane);
  EXPECT_NEAR(std::abs(plane->normal.z()), 1.0, 1e-3);
  EXPECT_NEAR(plane->thickness_m, 0.01, 1e-3);
  EXPECT_EQ(plane->n, 25U);
  EXPECT_FALSE(plane_of(std::span(points).first(5), 1.0)) << "too few";
  for (Eigen::Vector3d& p : points) p.y() = 0.0;
  EXPECT_FALSE(plane_of(points, 1.0)) << "a line";
  points.clear();
  for (int i = 0; i < 27; ++i) points.emplace_back(0.3 * (i % 3), 0.3 * (i / 3 % 3), 0.3 * (i / 9));
  EXPECT_FALSE(plane_of(points, 1.0)) << "a heap";
}

TEST(PlaneGrid, NearestIsAcrossTheBorderOfVoxels) {
  PointCloud cloud;  // a wall just below the border x = 1
  for (double y = 0.0; y < 1.0; y += 0.1) {
    for (double z = 0.0; z < 1.0; z += 0.1) cloud.positions.push_back(Eigen::Vector3d(0.97, y, z).cast<float>());
  }
  const PlaneGrid grid(cloud, 1.0);
  const PlanePatch* const met = grid.nearest({1.03, 0.5, 0.5});
  ASSERT_NE(met, nullptr);
  EXPECT_NEAR(std::abs(met->normal.x()), 1.0, 1e-6);
  EXPECT_EQ(grid.nearest({3.5, 0.5, 0.5}), nullptr);
}

TEST(PatchAgreement, OfAMapWithItselfIsWhole) {
  const PlaneGrid grid(block(1, 12), 1.0);
  const PatchAgreement same = agreement_of(grid, grid, Eigen::Isometry3d::Identity(), 0.2);
  EXPECT_EQ(same.share, 1.0);
  EXPECT_NEAR(same.score, 1.0, 1e-9);
  EXPECT_EQ(same.rmse_m, 0.0);
  EXPECT_GT(same.places, 100.0);
}

TEST(PatchAgreement, OfOtherSamplesIsHighWhereverTheyLie) {
  const PointCloud cloud = block(2, 12);
  PointCloud even, odd;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    (random_below(2, i, 99) == 0 ? even : odd).positions.push_back(cloud.positions[i]);
  const Eigen::Isometry3d T = moved_by({3.0, -7.0, 0.5}, {0.0, 0.0, 1.0});
  const PatchAgreement found =
      agreement_of(PlaneGrid(transformed(odd, T.inverse().matrix()), 1.0), PlaneGrid(even, 1.0), T, 0.2);
  EXPECT_GT(found.score, 0.7);
  EXPECT_LT(found.rmse_m, 0.05);
}

TEST(PatchAgreement, FallsWithTheErrorOfThePose) {
  const PlaneGrid grid(block(3, 12), 1.0);
  double last = 1.01;
  for (const double off_m : {0.0, 0.15, 0.4, 1.0}) {
    const double score = agreement_of(grid, grid, moved_by({off_m, off_m, 0.0}), 0.2).score;
    EXPECT_LE(score, last) << off_m;
    last = score;
  }
  EXPECT_LT(last, 0.3);
}

TEST(PatchAgreement, GroundAloneTellsNothing) {
  const PlaneGrid one(block(4, 0), 1.0), other(block(5, 0), 1.0);
  const PatchAgreement found = agreement_of(one, other, Eigen::Isometry3d::Identity(), 0.2);
  EXPECT_GT(found.share, 0.95);
  EXPECT_LT(found.places, 25.0);
}

TEST(PatchAgreement, OtherPlacesAgreeByChanceOnly) {
  const PlaneGrid one(block(6, 12), 1.0);
  for (std::uint64_t seed = 7; seed < 12; ++seed) {
    EXPECT_LT(agreement_of(PlaneGrid(block(seed, 12), 1.0), one, Eigen::Isometry3d::Identity(), 0.2).score, 0.3)
        << seed;
  }
}

TEST(PatchAgreement, OfNothingIsNothing) {
  const PlaneGrid empty(PointCloud{}, 1.0), grid(block(8, 3), 1.0);
  const PatchAgreement found = agreement_of(empty, grid, Eigen::Isometry3d::Identity(), 0.2);
  EXPECT_EQ(found.score, 0.0);
  EXPECT_EQ(found.share, 0.0);
  EXPECT_TRUE(std::isnan(found.rmse_m));
}

}  // namespace
}  // namespace cmap

#include "cmap/recon/map_fusion.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "cmap/core/error.hpp"

namespace cmap {
namespace map_fusion_test {

const Eigen::Isometry3d kIdentity = Eigen::Isometry3d::Identity();

FusionOptions voxels(double voxel_m, double doubt = 0.0) {
  FusionOptions options;
  options.voxel_m = voxel_m;
  options.doubt = doubt;
  return options;
}

FramePoints points(std::initializer_list<Eigen::Vector3f> positions, Rgb8 color, float confidence = 2.0f) {
  FramePoints frame;
  for (const Eigen::Vector3f& p : positions) {
    frame.positions.push_back(p);
    frame.colors.push_back(color);
    frame.confidence.push_back(confidence);
    frame.pixel.push_back(static_cast<std::uint32_t>(frame.pixel.size()));
  }
  return frame;
}

RgbF color(const PointCloud& map, std::size_t i) { return std::get<Array<RgbF>>(map.colors)[i]; }

/// Two points of one voxel, confidences 1 and 3: the mean lies three quarters of the way.
TEST(Fusion, MeanIsWeightedByConfidence) {
  MapFusion fusion(voxels(1.0));
  fusion.add(points({{0.1f, 0.5f, 0.5f}}, {0, 0, 0}, 1.0f), kIdentity, 1.0);
  fusion.add(points({{0.5f, 0.5f, 0.5f}}, {0, 0, 0}, 3.0f), kIdentity, 1.0);
  const PointCloud map = fusion.finish();
  ASSERT_EQ(map.size(), 1u);
  EXPECT_NEAR(map.world(0).x(), 0.4, 1e-6);
  EXPECT_EQ(fusion.points_added(), 2u);
}

TEST(Fusion, PlacesByPoseAndScale) {
  MapFusion fusion(voxels(0.1));
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  pose.translation() << 10, 20, 30;
  fusion.add(points({{1, 0, 0}}, {9, 9, 9}), pose, 4.0);
  EXPECT_NEAR((fusion.finish().world(0) - Eigen::Vector3d(10, 24, 30)).norm(), 0.0, 1e-5) << "4 m along the turned x";
}

/// Seven frames agree, one is wrong in all channels: it moves the color by less than its share of an eighth.
TEST(Fusion, OneWrongFrameDoesNotSpoilAColor) {
  MapFusion fusion(voxels(1.0));
  for (int i = 0; i < 7; ++i) fusion.add(points({{0.5f, 0.5f, 0.5f}}, {100, 150, 50}), kIdentity, 1.0);
  fusion.add(points({{0.5f, 0.5f, 0.5f}}, {255, 0, 255}), kIdentity, 1.0);
  const RgbF fused = color(fusion.finish(), 0);
  // Its weight is 1 / (1 + (298 / 25.5)^2) = 0.0073, its distance 155 / 255: 0.0006 on red.
  EXPECT_NEAR(fused[0], 100.0 / 255, 1e-3);
  EXPECT_NEAR(fused[1], 150.0 / 255, 1e-3);
  EXPECT_NEAR(fused[2], 50.0 / 255, 1.5e-3);
}

TEST(Fusion, PointsOfOneFrameCountAsOneColor) {
  MapFusion fusion(voxels(1.0));
  fusion.add(points({{0.1f, 0.1f, 0.1f}, {0.2f, 0.1f, 0.1f}, {0.3f, 0.1f, 0.1f}}, {10, 10, 10}), kIdentity, 1.0);
  fusion.add(points({{0.1f, 0.1f, 0.1f}}, {20, 20, 20}), kIdentity, 1.0);
  EXPECT_NEAR(color(fusion.finish(), 0)[0], 15.0 / 255, 1e-6) << "both equally far from their median";
}

/// What is in the map bounds the memory: a hundred equal frames make no more voxels than one.
TEST(Fusion, GrowsWithTheMapNotWithFrames) {
  MapFusion fusion(voxels(0.5));
  const FramePoints frame = points({{0.1f, 0, 0}, {1.1f, 0, 0}, {-0.1f, 0, 0}}, {1, 2, 3});
  for (int i = 0; i < 100; ++i) fusion.add(frame, kIdentity, 1.0);
  EXPECT_EQ(fusion.size(), 3u) << "-0.1 and 0.1 are in different voxels";
  EXPECT_EQ(fusion.points_added(), 300u);
}

/// A wall seen well, and noise of a far view 30 cm before it: the doubtful points go, the same far view elsewhere
/// stays.
TEST(Fusion, DoubtfulPointsGoWhereBetterOnesAre) {
  FramePoints wall, noise, far_wall;
  const auto add = [](FramePoints& frame, const Eigen::Vector3f& p, float confidence) {
    frame.positions.push_back(p);
    frame.colors.push_back({50, 50, 50});
    frame.confidence.push_back(confidence);
    frame.pixel.push_back(static_cast<std::uint32_t>(frame.pixel.size()));
  };
  for (float y = 0.025f; y < 2; y += 0.05f) {
    for (float z = 0.025f; z < 2; z += 0.05f) {
      add(wall, {0.025f, y, z}, 12.0f);
      if (y < 1 && z < 1) add(noise, {-0.275f, y, z}, 3.0f);
      add(far_wall, {20.025f, y, z}, 3.0f);
    }
  }
  const auto size_with = [&](double doubt) {
    MapFusion fusion(voxels(0.05, doubt));
    for (const FramePoints* frame : {&wall, &noise, &far_wall}) fusion.add(*frame, kIdentity, 1.0);
    return fusion.finish().size();
  };
  const std::size_t all = wall.positions.size() + noise.positions.size() + far_wall.positions.size();
  EXPECT_EQ(size_with(0.0), all);
  EXPECT_EQ(size_with(0.5), wall.positions.size() + far_wall.positions.size());
  EXPECT_EQ(size_with(0.2), all) << "3 of 12 is above a fifth";
}

TEST(Fusion, FarFromTheOriginNothingIsLost) {
  MapFusion near_map(voxels(0.2)), far_map(voxels(0.2));
  const FramePoints frame = points({{0.03f, 0.05f, 0.11f}, {1.07f, 0.3f, 2.2f}}, {1, 2, 3});
  Eigen::Isometry3d far = kIdentity;
  far.translation() << 500000, 4000000, 100;
  near_map.add(frame, kIdentity, 1.0);
  far_map.add(frame, far, 1.0);
  const PointCloud a = near_map.finish(), b = far_map.finish();
  for (std::size_t i = 0; i < 2; ++i) {
    // Doubles hold 4e6 m to 1e-9, floats the offset from the cloud's origin of at most 1 km to 6e-5.
    EXPECT_LT((b.world(i) - far.translation() - a.world(i)).norm(), 1e-4);
  }
}

TEST(Fusion, RefusesVoxelsThatCannotBe) {
  EXPECT_THROW(MapFusion(voxels(0.0)), UsageError);
  EXPECT_THROW(MapFusion(voxels(NAN)), UsageError);
  MapFusion fusion(voxels(1e-9));
  EXPECT_THROW(fusion.add(points({{100, 0, 0}}, {}), kIdentity, 1.0), UsageError);
}

TEST(Fusion, OfNothingIsEmpty) { EXPECT_EQ(MapFusion(voxels(0.1)).finish().size(), 0u); }

}  // namespace map_fusion_test
}  // namespace cmap

#include "cmap/colorize/refine_extrinsic.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "cmap/core/error.hpp"
#include "cmap/core/execution.hpp"
#include "colorize/colorize_testing.hpp"

namespace cmap {
namespace refine_extrinsic_test {

constexpr double kDegree = std::numbers::pi / 180.0;

/// Half a degree and 3 cm.
Eigen::Isometry3d perturbed(const Eigen::Isometry3d& T_lidar_camera) {
  Eigen::Isometry3d by = Eigen::Isometry3d::Identity();
  by.linear() = rotation_from(0.5 * kDegree * Eigen::Vector3d(1, -1, 1).normalized());
  by.translation() = 0.03 * Eigen::Vector3d(-1, 1, 1).normalized();
  return T_lidar_camera * by;
}

/// Exact pictures of smooth colors can be aligned better than real ones.
RefineOptions exact() {
  RefineOptions options;
  options.alignment_px = 0.02;
  options.most_points = 6000;
  return options;
}

void check_recovery(const CameraModel& camera) {
  PosedImages images = test::painted_images(camera, 24);
  const Eigen::Isometry3d truth = images.T_lidar_camera;
  images.T_lidar_camera = perturbed(truth);
  const RefinedExtrinsic refined = refine_extrinsic(test::PaintedRoom().map(0.1), images, {}, exact());
  const Eigen::Isometry3d left = truth.inverse() * refined.T_lidar_camera;
  EXPECT_LT(rotation_angle_rad(left.linear()), 0.02 * kDegree);
  EXPECT_LT(left.translation().norm(), 0.002);
  EXPECT_TRUE(refined.improved);
  EXPECT_TRUE(refined.free_axes.empty());
  EXPECT_LT(refined.inconsistency_after, 0.5 * refined.inconsistency_before);
  EXPECT_NEAR(refined.turn_deg.norm(), 0.5, 0.02);
}

TEST(RefineExtrinsic, RecoversHalfADegreeAndThreeCentimeters) { check_recovery(test::small_pinhole()); }
TEST(RefineExtrinsic, OfAFisheyeToo) { check_recovery(test::small_fisheye()); }

TEST(RefineExtrinsic, LeavesARightOneWhereItIs) {
  const PosedImages images = test::painted_images(test::small_pinhole(), 24);
  const RefinedExtrinsic refined = refine_extrinsic(test::PaintedRoom().map(0.1), images, {}, exact());
  EXPECT_LT(refined.turn_deg.norm(), 0.02);
  EXPECT_LT(refined.shift_m.norm(), 0.002);
}

/// From a straight way a shift of the camera moves all colors alike, but for what corners tell: no image contradicts
/// another.
TEST(RefineExtrinsic, AStraightWayDoesNotTellWhereTheCameraSits) {
  PosedImages images = test::painted_images(test::small_pinhole(), 12);
  const Eigen::Isometry3d truth = images.T_lidar_camera;
  for (std::size_t i = 0; i < images.list.size(); ++i) {
    images.list[i].T_world_lidar = Eigen::Isometry3d::Identity();
    images.list[i].T_world_lidar.translation() << -4.0 + 0.4 * static_cast<double>(i), 0.0, 0.0;
  }
  std::vector<Eigen::Isometry3d> cameras;
  for (std::size_t i = 0; i < images.list.size(); ++i) cameras.push_back(images.T_world_camera(i));
  const CameraModel camera = images.camera;
  images.read = [cameras, camera](std::size_t place) { return test::PaintedRoom().picture(camera, cameras[place]); };
  images.T_lidar_camera = perturbed(truth);
  RefineOptions options;
  options.most_points = 6000;
  const RefinedExtrinsic refined = refine_extrinsic(test::PaintedRoom().map(0.1), images, {}, options);
  EXPECT_GE(refined.free_axes.size(), 2u);
}

TEST(RefineExtrinsic, IsTheSameForAnyNumberOfThreads) {
  PosedImages images = test::painted_images(test::small_pinhole(), 20);
  images.T_lidar_camera = perturbed(images.T_lidar_camera);
  const auto with_threads = [&](int threads) {
    const ExecutionScope scope({.threads = threads});
    return refine_extrinsic(test::PaintedRoom().map(0.15), images, {}, exact()).T_lidar_camera.matrix();
  };
  EXPECT_EQ(with_threads(1), with_threads(4));
}

TEST(RefineExtrinsic, NeedsViewsThatShareSomething) {
  const PosedImages images = test::painted_images(test::small_pinhole(), 1);
  EXPECT_THROW(refine_extrinsic(test::PaintedRoom().map(0.2), images), UnsupportedError);
}

}  // namespace refine_extrinsic_test
}  // namespace cmap

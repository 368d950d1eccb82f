#include "io/real_data.hpp"

#include "cmap/io/transform_file.hpp"

namespace cmap::testing {
namespace {

TEST_F(RealData, TumPlyCounts) {
  EXPECT_EQ(read("tum_fr1/reference.ply").info.finite_points, 904998U);
  const auto estimate = read("tum_fr1/estimate.ply");
  EXPECT_EQ(estimate.info.finite_points, 874221U);
  EXPECT_EQ(color_type_name(estimate.cloud.colors), "u8");
}

TEST_F(RealData, AutzenLasIsThePlyShifted) {
  const auto las = read("autzen/stadium_utm.las");
  const auto ply = read("autzen/autzen_stadium_300m.ply");
  EXPECT_EQ(las.info.format, "LAS 1.2 format 3");
  ASSERT_EQ(las.info.finite_points, 280460U);
  // The LAS file holds the middle 200 m of the PLY file, in the same order.
  const auto& las_colors = std::get<Array<Rgb16>>(las.cloud.colors);
  const auto& ply_colors = std::get<Array<Rgb8>>(ply.cloud.colors);
  const Eigen::Vector3d offset(636000, 849000, 0);
  constexpr double kTolerance_m = 0.0005 + 2e-5;  // half a LAS step, and the floats of the PLY file
  std::size_t matched = 0;
  for (std::size_t i = 0; i < ply.cloud.size() && matched < las.cloud.size(); ++i) {
    const double error = (las.cloud.world(matched) - ply.cloud.world(i) - offset).cwiseAbs().maxCoeff();
    if (error > kTolerance_m) continue;
    ASSERT_EQ(las_colors[matched][0], 257 * ply_colors[i][0]);
    ++matched;
  }
  EXPECT_EQ(matched, las.cloud.size());
}

TEST_F(RealData, KinectPcdDropsUnmeasuredPixels) {
  const auto file = read("pcl_kinect3/pcd/frame_20121214T142255.814212.pcd");
  EXPECT_EQ(file.info.format, "PCD compressed");
  EXPECT_EQ(file.info.points, 307200U);
  EXPECT_EQ(file.info.finite_points, 271575U);
  EXPECT_EQ(color_type_name(file.cloud.colors), "u8");
}

TEST_F(RealData, LidarPcdWithForeignFields) {
  EXPECT_EQ(read("opencalib/lidar2camera/auto_calib/data/calib.pcd").info.points, 85546U);
  const auto ascii = read("opencalib/lidar2camera/manual_calib/data/0.pcd");
  EXPECT_EQ(ascii.info.points, 78238U);
  EXPECT_EQ(ascii.cloud.positions[0], Eigen::Vector3f(21.647913F, 0.19822195F, -1.8524752F));
}

TEST_F(RealData, CloudComparePlyAndTransform) {
  EXPECT_EQ(read("small_gicp/data/source.ply").info.points, 69792U);
  EXPECT_EQ(read("small_gicp/data/target.ply").info.points, 69088U);
  EXPECT_EQ(read_transform(folder_ / "small_gicp/data/T_target_source.txt").T(3, 3), 1.0);
}

}  // namespace
}  // namespace cmap::testing

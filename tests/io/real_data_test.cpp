#include "io/real_data.hpp"

#include <Eigen/Geometry>

#include "cmap/io/transform_file.hpp"

namespace cmap::testing {
namespace real_data_test {

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

TEST_F(RealData, AutzenBmxLasComesOutInMeters) {
  // Meters across, US survey feet up: by its header from 422.93 to 434.51 of them.
  const auto las = read("autzen_bmx_two_epochs/autzen-bmx-2010.las");
  EXPECT_EQ(las.info.format, "LAS 1.4 format 7");
  ASSERT_EQ(las.info.finite_points, 829U);
  Eigen::AlignedBox3d box;
  for (std::size_t i = 0; i < las.cloud.size(); ++i) box.extend(point(las, i));
  EXPECT_LT((box.min() - Eigen::Vector3d(194472.82, 259222.19, 422.93 * 1200 / 3937)).norm(), 1e-3);
  EXPECT_LT((box.max() - Eigen::Vector3d(194506.92, 259264.09, 434.51 * 1200 / 3937)).norm(), 1e-3);
  EXPECT_EQ(read("autzen_bmx_two_epochs/autzen-bmx-2023.las").info.finite_points, 687U);
}

TEST_F(RealData, LasOfEveryVersionAndFormat) {
  // Of the synthetic files, half of the points are withheld and eight are noise, says laspy.
  const auto las = read("formats_laz/pdrf/pdrf7-v4-1.4.las");
  EXPECT_EQ(las.info.points, 1024U);
  EXPECT_EQ(las.info.finite_points, 504U);
  EXPECT_EQ(read("formats_laz/pdrf/pdrf10-1.5.las").info.format, "LAS 1.5 format 10");
  EXPECT_EQ(read("formats_laz/pdrf/pdrf5-1.3.las").info.points, 1024U);
  const auto feet = read("formats_laz/pairs/1_4_w_evlr.las");
  EXPECT_NEAR(point(feet, 0).x(), 516487.799, 2e-3);
  EXPECT_EQ(feet.info.warnings.size(), 1U) << "its heights are feet by name and meters by factor";
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

// PDAL's test files. The counts are those of the lines; the places were computed by hand from header and line.
TEST_F(RealData, PtxScans) {
  const auto colored = read("formats_text/1.2-with-color.ptx");
  EXPECT_EQ(colored.info.points, 1065U);
  EXPECT_EQ(colored.info.finite_points, 1065U);
  EXPECT_TRUE(colored.info.warnings.empty());
  EXPECT_LT((colored.cloud.world(0) - Eigen::Vector3d(637012.24, 849028.31, 431.66)).norm(), 1e-3);
  EXPECT_EQ(std::get<Array<Rgb8>>(colored.cloud.colors)[0], (Rgb8{68, 77, 88}));

  const auto one = read("formats_text/complex-transform.ptx");
  EXPECT_EQ(one.info.points, 12U);
  EXPECT_EQ(one.info.finite_points, 4U);
  // x = 0.999979 * -0.00563 + 0.003613 * 0.645218 + 0.005359 * -0.440506 - 3.028748, and so on down the columns
  EXPECT_LT((one.cloud.world(0) - Eigen::Vector3d(-3.034407381, -3.173781036, -1.823750042)).norm(), 1e-5);
  EXPECT_EQ(one.info.sensor_positions, std::vector{Eigen::Vector3d(-3.028748, -3.819741, -1.384333)});

  const auto two = read("formats_text/multiple-and-transform.ptx");
  EXPECT_EQ(two.info.finite_points, 8U);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_LT((two.cloud.world(i) - two.cloud.world(i + 4)).norm(), 1e-3);
}

TEST_F(RealData, OpenSfmPoints) {
  const auto file = read("opensfm_berlin/reconstruction_example.json");
  EXPECT_EQ(file.info.points, 1430U);
  EXPECT_EQ(color_type_name(file.cloud.colors), "u8");
}

TEST_F(RealData, AnObjWithFacesIsNamed) {
  try {
    read("formats_text/1.2-with-color.obj");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("is a mesh"));
  }
}

TEST_F(RealData, CloudComparePlyAndTransform) {
  EXPECT_EQ(read("small_gicp/data/source.ply").info.points, 69792U);
  EXPECT_EQ(read("small_gicp/data/target.ply").info.points, 69088U);
  EXPECT_EQ(read_transform(folder_ / "small_gicp/data/T_target_source.txt").T(3, 3), 1.0);
}

}  // namespace real_data_test
}  // namespace cmap::testing

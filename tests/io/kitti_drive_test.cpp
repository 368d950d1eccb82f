#include <fmt/format.h>

#include <cmath>

#include "cmap/io/capture.hpp"
#include "cmap/io/lidar_scan_file.hpp"
#include "io/real_data.hpp"

namespace cmap::testing {
namespace kitti_drive_test {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::FloatNear;
using ::testing::HasSubstr;

/// A drive of two scans, two images and two measurements; the calibration lies above it, as KITTI's does.
class KittiDrive : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* sensor : {"velodyne_points", "image_02", "oxts"})
      fs::create_directories(drive() / sensor / "data");
    put("../calib_imu_to_velo.txt", "calib_time: 25-May-2012 16:47:16\nR: 1 0 0 0 1 0 0 0 1\nT: -0.8 0.3 -0.8\n");
    put("../calib_velo_to_cam.txt", "R: 0 -1 0 0 0 -1 1 0 0\nT: 0 0 -0.25\ndelta_f: 0 0\n");
    put("../calib_cam_to_cam.txt",
        "corner_dist: 0.1\nS_rect_02: 1242 375\nR_rect_00: 1 0 0 0 1 0 0 0 1\n"
        "P_rect_02: 700 0 600 42 0 700 170 0 0 0 1 0\n");
    put("velodyne_points/timestamps_start.txt",
        "2011-09-26 13:08:24.900000000\n2011-09-26 13:08:25.000000000\n2011-09-26 13:08:25.100000000\n");
    put("velodyne_points/timestamps_end.txt",
        "2011-09-26 13:08:25.000000000\n2011-09-26 13:08:25.100000000\n2011-09-26 13:08:25.200000000\n");
    for (const char* sensor : {"image_02", "oxts"}) {
      put(std::string(sensor) + "/timestamps.txt", "2011-09-26 13:08:24.950000000\n2011-09-26 13:08:25.050000000\n");
    }
    for (const char* name : {"0000000000", "0000000002"}) {  // one is missing, as in some drives
      put(std::string("velodyne_points/data/") + name + ".bin",
          Bytes()
              .put(-5.0F, 0.01F, 0.0F, 0.5F, 0.0F, 5.0F, 0.0F, 0.25F, 5.0F, 0.0F, 1.0F, 0.0F, 0.0F, -5.0F, 0.0F, 1.0F,
                   NAN, 0.0F, 0.0F, 0.0F)
              .str());
    }
    std::string oxts;
    for (int i = 0; i < 30; ++i) oxts += fmt::format("{} ", i);
    for (const char* name : {"0000000000", "0000000001"}) {
      put(std::string("image_02/data/") + name + ".png", "\x89PNG");
      put(std::string("oxts/data/") + name + ".txt", oxts + "\n");
    }
  }
  fs::path drive() const { return folder_.path() / "drive"; }
  void put(std::string_view name, std::string_view bytes) const { folder_.write("drive/" + std::string(name), bytes); }
  std::string refusal() const {
    try {
      const Capture capture = open_capture(drive());
      for (const StampedFile& scan : capture.scans) read_lidar_scan(scan.path, scan.time_s);
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  }

 private:
  TempFolder folder_;
};

TEST_F(KittiDrive, IsACapture) {
  const Capture capture = open_capture(drive());
  ASSERT_EQ(capture.scans.size(), 2U);
  EXPECT_DOUBLE_EQ(capture.scans[0].time_s, 1317042504.9) << "the start of the turn";
  EXPECT_DOUBLE_EQ(capture.scans[1].time_s, 1317042505.1) << "by number";
  EXPECT_EQ(capture.images.size(), 2U);
  ASSERT_EQ(capture.imu.size(), 2U);
  EXPECT_EQ(capture.imu[0].specific_force_mps2, Eigen::Vector3d(11, 12, 13));
  EXPECT_EQ(capture.imu[0].angular_rate_radps, Eigen::Vector3d(17, 18, 19));
  EXPECT_TRUE(capture.lio.empty()) << "GPS is no LiDAR-inertial odometry";
  EXPECT_EQ(capture.calibration.camera.width, 1242);
  EXPECT_EQ(capture.calibration.camera.fx, 700);
  // A point 10 m ahead of the LiDAR: camera 0 sees it 9.75 m away, camera 2 is 6 cm to its left.
  const Eigen::Vector3d seen = capture.calibration.T_lidar_camera.inverse() * Eigen::Vector3d(10, 0, 0);
  EXPECT_TRUE(seen.isApprox(Eigen::Vector3d(0.06, 0, 9.75), 1e-12)) << seen;
  EXPECT_TRUE((capture.calibration.T_imu_lidar.translation()).isApprox(Eigen::Vector3d(0.8, -0.3, 0.8), 1e-12));
}

TEST_F(KittiDrive, PointsHaveTheTimesOfTheirDirections) {
  const Capture capture = open_capture(drive());
  const LidarScan scan = read_lidar_scan(capture.scans[0].path, capture.scans[0].time_s);
  ASSERT_EQ(scan.positions.size(), 4U) << "what is no number is left out";
  // From behind over the left, the front and the right.
  EXPECT_THAT(scan.time_s, ElementsAre(FloatNear(0.0F, 5e-5F), FloatNear(0.025F, 1e-6F), FloatNear(0.05F, 1e-6F),
                                       FloatNear(0.075F, 1e-6F)));
  EXPECT_THAT(scan.intensity, ElementsAre(0.5F, 0.25F, 0.0F, 1.0F));
}

TEST_F(KittiDrive, OneThatIsNotSynchronizedHasScansAsTextAndImagesAsTheyWereTaken) {
  const fs::path extract = drive().parent_path() / "drive_extract";
  fs::rename(drive(), extract);
  fs::create_directory(drive());  // a place for the calibration's name
  put("../calib_cam_to_cam.txt",
      "S_02: 1392 512\nK_02: 960 0 696 0 950 224 0 0 1\nD_02: -0.37 0.2 0.001 0.002 -0.07\n"
      "R_02: 1 0 0 0 1 0 0 0 1\nT_02: 0.06 0 0\n");
  fs::remove(extract / "velodyne_points/data/0000000002.bin");
  fs::remove(extract / "velodyne_points/data/0000000000.bin");
  put("../drive_extract/velodyne_points/data/0000000001.txt", "5.0 0.0 1.0 0.5\n0 -5 0 1\n");
  const Capture capture = open_capture(extract);
  ASSERT_EQ(capture.scans.size(), 1U);
  const LidarScan scan = read_lidar_scan(capture.scans[0].path, capture.scans[0].time_s);
  EXPECT_THAT(scan.positions, ElementsAre(Eigen::Vector3f(5, 0, 1), Eigen::Vector3f(0, -5, 0)));
  EXPECT_THAT(scan.time_s, ElementsAre(FloatNear(0.05F, 1e-6F), FloatNear(0.075F, 1e-6F)));
  EXPECT_EQ(capture.calibration.camera.width, 1392);
  EXPECT_EQ(capture.calibration.camera.fy, 950);
  EXPECT_EQ(capture.calibration.camera.distortion.size(), 5U);
  const Eigen::Vector3d seen = capture.calibration.T_lidar_camera.inverse() * Eigen::Vector3d(10, 0, 0);
  EXPECT_TRUE(seen.isApprox(Eigen::Vector3d(0.06, 0, 9.75), 1e-12)) << seen;
  put("../drive_extract/velodyne_points/data/0000000001.txt", "5.0 0.0 1.0\n");
  EXPECT_THROW(read_lidar_scan(capture.scans[0].path, capture.scans[0].time_s), InputError);
}

TEST_F(KittiDrive, WhatIsNotAskedForNeedNotBeThere) {
  fs::remove_all(drive() / "image_02");
  EXPECT_THAT(refusal(), HasSubstr("image_02/timestamps.txt: no such file"));
  const Capture capture = open_capture(drive(), {.images = Want::kIfUsable});
  EXPECT_TRUE(capture.images.empty());
}

TEST_F(KittiDrive, WhatIsWrongIsNamed) {
  put("velodyne_points/data/0000000009.bin", "0123456789abcdef");
  EXPECT_THAT(refusal(), HasSubstr("timestamps_start.txt has only 3 times"));
  SetUp();
  fs::remove(drive() / "velodyne_points/data/0000000009.bin");
  put("velodyne_points/data/0000000002.bin", "0123456789abcde");
  EXPECT_THAT(refusal(), HasSubstr("15 bytes are no whole number of points"));
  SetUp();
  put("velodyne_points/timestamps_end.txt", "2011-09-26 13:08:23.000000000\n");
  EXPECT_THAT(refusal(), HasSubstr("timestamps_end.txt: line 1: the turn that began"));
  SetUp();
  put("oxts/timestamps.txt", "26.9.2011 13:08:24.95\n");
  EXPECT_THAT(refusal(), HasSubstr("oxts/timestamps.txt: line 1: '26.9.2011 13:08:24.95' is no time"));
  SetUp();
  put("oxts/data/0000000001.txt", "1 2 3\n");
  EXPECT_THAT(refusal(), HasSubstr("3 numbers; 30 expected"));
  SetUp();
  put("../calib_velo_to_cam.txt", "R: 0 -1 0 0 0 -1 1 0.5 0\nT: 0 0 -0.25\n");
  EXPECT_THAT(refusal(), HasSubstr("calib_velo_to_cam.txt: R is no rotation"));
  SetUp();
  put("../calib_cam_to_cam.txt", "S_rect_02: 1242 375\n");
  EXPECT_THAT(refusal(), HasSubstr("calib_cam_to_cam.txt: no line \"P_rect_02:\""));
}

/// Real scans whose times were made from KITTI's stamps; a drive of them gives these times.
class RealKittiDrive : public RealData {};

TEST_F(RealKittiDrive, TimesAreThoseOfTheCapture) {
  if (!fs::is_directory(folder_ / "kitti_0009")) GTEST_SKIP() << "no kitti_0009";
  const Capture capture = open_capture(folder_ / "kitti_0009", {.sessions = Want::kNo});
  const StampedFile& file = capture.scans[20];
  const LidarScan scan = read_lidar_scan(file.path, file.time_s);
  const TempFolder folder;
  fs::create_directories(folder / "velodyne_points/data");
  Bytes points;
  for (const Eigen::Vector3f& p : scan.positions) points.put(p.x(), p.y(), p.z(), 0.0F);
  const double turn_s = capture.scans[21].time_s - file.time_s;
  const auto stamp = [](double time_s) {
    const double of_minute = std::fmod(time_s, 60.0);
    return fmt::format("2011-09-26 13:08:{:012.9f}\n", of_minute);
  };
  const fs::path bin = folder.write("velodyne_points/data/0000000000.bin", points.str());
  folder.write("velodyne_points/timestamps_end.txt", stamp(file.time_s + turn_s));
  const LidarScan again = read_lidar_scan(bin, file.time_s);
  ASSERT_EQ(again.time_s.size(), scan.time_s.size());
  float worst_s = 0.0F;
  for (std::size_t i = 0; i < scan.time_s.size(); ++i)
    worst_s = std::max(worst_s, std::abs(again.time_s[i] - scan.time_s[i]));
  EXPECT_LT(worst_s, 2e-4F) << "a turn's end is the next one's start but for some microseconds";
}

}  // namespace kitti_drive_test
}  // namespace cmap::testing

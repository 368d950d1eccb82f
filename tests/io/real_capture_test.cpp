#include <zlib.h>

#include <cstdio>
#include <sstream>

#include "cmap/io/capture.hpp"
#include "cmap/io/lidar_scan_file.hpp"
#include "io/capture_testing.hpp"
#include "io/real_data.hpp"

namespace cmap::testing {
namespace real_capture_test {

using RealCapture = RealData;
namespace fs = std::filesystem;

template <class T>
unsigned long crc(const Array<T>& values) {
  return ::crc32_z(0, reinterpret_cast<const Bytef*>(values.data()), values.size() * sizeof(T));
}

/// What NumPy reads from the same files: checksums of the values as float32 or bytes. Empty where there is no NumPy.
std::vector<unsigned long> numpy_checksums(const std::string& script) {
  const std::string command = "/usr/bin/python3 -c 'import numpy as np, zlib\n" + script + "' 2>/dev/null";
  std::FILE* pipe = ::popen(command.c_str(), "r");
  std::vector<unsigned long> values;
  unsigned long value = 0;
  while (pipe != nullptr && std::fscanf(pipe, "%lu", &value) == 1) values.push_back(value);
  if (pipe != nullptr) ::pclose(pipe);
  return values;
}

TEST_F(RealCapture, KittiCaptureOpens) {
  const Capture capture = open_capture(folder_ / "kitti_0009");
  EXPECT_EQ(capture.images.size(), 51U);
  EXPECT_EQ(capture.scans.size(), 51U);
  EXPECT_EQ(capture.imu.size(), 53U);
  EXPECT_EQ(capture.lio.size(), 52U);
  EXPECT_EQ(capture.sessions.size(), 4U);
  EXPECT_TRUE(capture.warnings.empty());
  EXPECT_EQ(capture.calibration.camera.width, 1242);
  EXPECT_NEAR(capture.images[0].time_s - capture.scans[0].time_s, 0.062337, 1e-6);
  Eigen::Vector3d mean_force = Eigen::Vector3d::Zero();
  for (const ImuSample& sample : capture.imu) mean_force += sample.specific_force_mps2 / 53.0;
  EXPECT_NEAR(mean_force.z(), 9.8, 0.1) << "as the data set's description says";
}

TEST_F(RealCapture, KittiScansAreReadWhole) {
  const Capture capture = open_capture(folder_ / "kitti_0009");
  std::size_t points = 0;
  for (const StampedFile& file : capture.scans) {
    const LidarScan scan = read_lidar_scan(file.path, file.time_s);
    points += scan.positions.size();
    ASSERT_EQ(scan.intensity.size(), scan.positions.size());
    ASSERT_EQ(scan.time_s.size(), scan.positions.size());
    EXPECT_TRUE(scan.ring.empty());
    EXPECT_TRUE(std::is_sorted(scan.time_s.begin(), scan.time_s.end()));
    EXPECT_GE(scan.time_s.front(), -1e-6F);
    EXPECT_LE(scan.time_s.back(), 0.105F) << "a turn";
  }
  EXPECT_EQ(points, 1347366U) << "as the data set's description says";
}

/// The scan's points in the image's frame mostly lie on the image: the calibration was read the right way around.
TEST_F(RealCapture, KittiPointsAheadProjectIntoTheImage) {
  const Capture capture = open_capture(folder_ / "kitti_0009");
  const Eigen::Isometry3d T_camera_lidar = capture.calibration.T_lidar_camera.inverse();
  const LidarScan scan = read_lidar_scan(capture.scans[0].path, capture.scans[0].time_s);
  std::size_t ahead = 0, inside = 0;
  for (const Eigen::Vector3f& p : scan.positions) {
    if (p.x() < 10.0F || std::abs(p.y()) > 0.6F * p.x() || p.z() > 0.0F) continue;
    ++ahead;
    const auto pixel = project(capture.calibration.camera, T_camera_lidar * p.cast<double>());
    inside += pixel && is_inside(capture.calibration.camera, *pixel) ? 1 : 0;
  }
  EXPECT_GT(ahead, 1000U);
  EXPECT_GT(inside, ahead * 95 / 100);
}

TEST_F(RealCapture, KittiSessionsAreReadWholeAndAsNumpyReadsThem) {
  const Capture capture = open_capture(folder_ / "kitti_0009");
  const int first_frames[] = {0, 12, 24, 36};
  for (std::size_t k = 0; k < capture.sessions.size(); ++k) {
    const SessionPredictions session = read_session_predictions(capture.sessions[k]);
    EXPECT_EQ(session.width, 518);
    EXPECT_EQ(session.height, 154);
    ASSERT_EQ(session.frame_count(), k == 3 ? 15U : 17U);
    EXPECT_TRUE(session.warnings.empty());
    for (std::size_t i = 0; i < session.frame_count(); ++i) {
      const StampedFile& image = capture.images[static_cast<std::size_t>(first_frames[k]) + i];
      EXPECT_EQ(session.frames[i].image_name, image.path.filename());
      EXPECT_EQ(session.frames[i].time_s, image.time_s);
    }
    const auto expected = numpy_checksums(
        fmt::format("for name, kind in ((\"depth\", \"<f4\"), (\"depth_conf\", \"<f4\"), (\"images\", \"|u1\")):\n"
                    "  print(zlib.crc32(np.load(\"{}/\" + name + \".npy\").astype(kind).tobytes()))",
                    capture.sessions[k].string()));
    if (expected.empty()) GTEST_SKIP() << "no NumPy to compare with";
    EXPECT_EQ((std::vector{crc(session.depth), crc(session.depth_confidence), crc(session.images)}), expected);
  }
}

TEST_F(RealCapture, KittiSessionWrittenAndReadBackIsIdentical) {
  const TempFolder folder;
  const SessionPredictions session = read_session_predictions(folder_ / "kitti_0009/predictions/session_0003");
  write_session_predictions(session, folder / "copy");
  const SessionPredictions copy = read_session_predictions(folder / "copy");
  EXPECT_EQ(copy.depth, session.depth);
  EXPECT_EQ(copy.depth_confidence, session.depth_confidence);
  EXPECT_EQ(copy.images, session.images);
  EXPECT_EQ(copy.intrinsics, session.intrinsics);
  for (std::size_t i = 0; i < session.frame_count(); ++i) {
    EXPECT_EQ(copy.frames[i].time_s, session.frames[i].time_s);
    // Rotations are projected once more: rounding alone.
    EXPECT_TRUE(copy.T_camera_session[i].matrix().isApprox(session.T_camera_session[i].matrix(), 1e-14));
  }
}

TEST_F(RealCapture, VggtSlamPointMapsAreAsNumpyReadsThem) {
  std::size_t maps = 0, pixels = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / "vggt_slam_pointmaps")) {
    if (entry.path().extension() != ".npz") continue;
    const PointMap map = read_point_map(entry.path());
    EXPECT_EQ(map.width, 518);
    EXPECT_EQ(map.height, 294);
    EXPECT_NEAR(map.time_s, std::stod(entry.path().stem().string()), 1e-6);
    ++maps;
    pixels += map.points.size();
    const auto expected =
        numpy_checksums(fmt::format("f = np.load(\"{}\")\n"
                                    "for name, kind in ((\"pointcloud\", \"<f4\"), (\"mask\", \"|u1\")): "
                                    "print(zlib.crc32(f[name].astype(kind).tobytes()))",
                                    entry.path().string()));
    if (expected.empty()) GTEST_SKIP() << "no NumPy to compare with";
    EXPECT_EQ((std::vector{crc(map.points), crc(map.mask)}), expected);
  }
  EXPECT_EQ(maps, 7U);
  EXPECT_EQ(pixels, 1066044U) << "as the data set's description says";
}

/// A LiDAR of another maker: fields of other types, among them some that are not asked for.
TEST_F(RealCapture, OpencalibScanWithRings) {
  const LidarScan scan = read_lidar_scan(folder_ / "opencalib/lidar2camera/auto_calib/data/calib.pcd", 0.0);
  EXPECT_EQ(scan.positions.size(), 85546U);
  EXPECT_EQ(scan.intensity.size(), 85546U);
  ASSERT_EQ(scan.ring.size(), 85546U);
  EXPECT_LE(*std::max_element(scan.ring.begin(), scan.ring.end()), 63) << "a scanner of 64 beams";
}

}  // namespace real_capture_test
}  // namespace cmap::testing

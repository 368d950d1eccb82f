#include <sys/wait.h>
#include <unistd.h>

#include "cmap/io/capture.hpp"
#include "cmap/io/lidar_scan_file.hpp"
#include "io/capture_testing.hpp"

namespace cmap::testing {
namespace capture_writer_test {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

CaptureCalibration calibration() { return CaptureText().open().calibration; }

LidarScan scan_at(double time_s) {
  LidarScan scan;
  scan.timestamp_s = time_s;
  scan.positions = {{1, 2, 3}, {0.1F, -5, 1e-3F}};
  scan.intensity = {7, 0.25F};
  scan.time_s = {0, 0.0625F};
  scan.ring = {0, 65535};
  return scan;
}

void write_small_capture(const fs::path& folder) {
  CaptureWriter writer(folder, calibration());
  for (const double time_s : {1.125, 1317042504.967931}) {
    std::ofstream(writer.add_image(time_s, ".png")) << "not looked at";
    writer.add_scan(scan_at(time_s));
  }
  writer.write_imu(std::vector<ImuSample>{{0.1, {0.1, 1.0 / 3, -2}, {9.81, 1e-9, 0}}});
  writer.write_lio({{1.5, {1, 2, 3}, Eigen::Quaterniond::Identity()}});
  writer.add_session(SessionText().read());
  writer.add_session(SessionText().read());
  std::ofstream(writer.subfolder("truth") / "scales.json") << "{}";
  writer.commit();
}

TEST(CaptureWriter, WrittenAndReadBackIsIdentical) {
  const TempFolder folder;
  write_small_capture(folder / "new");
  EXPECT_FALSE(fs::exists(folder / "new.partial"));
  const Capture capture = open_capture(folder / "new");
  EXPECT_TRUE(capture.warnings.empty());
  EXPECT_EQ(capture.calibration.camera.distortion, calibration().camera.distortion);
  EXPECT_EQ(capture.calibration.T_imu_lidar.matrix(), calibration().T_imu_lidar.matrix());
  EXPECT_EQ(capture.calibration.T_lidar_camera.matrix(), calibration().T_lidar_camera.matrix());
  EXPECT_EQ(capture.calibration.image_time_offset_s, 0.5);
  ASSERT_EQ(capture.images.size(), 2U);
  EXPECT_EQ(capture.images[0].time_s, 1.125);
  EXPECT_EQ(capture.images[1].time_s, 1317042504.967931);
  EXPECT_THAT(read_bytes(folder / "new/images.csv"), HasSubstr("0.625,images/000000.png")) << "as recorded";
  ASSERT_EQ(capture.scans.size(), 2U);
  const LidarScan scan = read_lidar_scan(capture.scans[1].path, capture.scans[1].time_s);
  EXPECT_EQ(scan.timestamp_s, 1317042504.967931);
  EXPECT_EQ(scan.positions, scan_at(0).positions);
  EXPECT_EQ(scan.intensity, scan_at(0).intensity);
  EXPECT_EQ(scan.time_s, scan_at(0).time_s);
  EXPECT_EQ(scan.ring, scan_at(0).ring);
  ASSERT_EQ(capture.imu.size(), 1U);
  EXPECT_DOUBLE_EQ(capture.imu[0].time_s, 0.1);  // less and plus the offset
  EXPECT_EQ(capture.imu[0].angular_rate_radps, Eigen::Vector3d(0.1, 1.0 / 3, -2));
  EXPECT_EQ(capture.imu[0].specific_force_mps2, Eigen::Vector3d(9.81, 1e-9, 0));
  ASSERT_EQ(capture.lio.size(), 1U);
  EXPECT_EQ(capture.lio[0].position, Eigen::Vector3d(1, 2, 3));
  ASSERT_EQ(capture.sessions.size(), 2U);
  EXPECT_EQ(read_session_predictions(capture.sessions[1]).depth, SessionText().read().depth);
  EXPECT_TRUE(fs::exists(folder / "new/truth/scales.json"));
}

TEST(CaptureWriter, FramesAreRecordedWithoutTheOffset) {
  const TempFolder folder;
  {
    CaptureWriter writer(folder / "new", calibration());
    writer.add_session(SessionText().read());
    std::ofstream(writer.add_image(1, ".png")) << "not looked at";
    writer.add_scan(scan_at(1));
    writer.commit();
  }
  EXPECT_THAT(read_bytes(folder / "new/predictions/session_0000/frames.csv"), HasSubstr("\n0,10,a.jpg,30,20\n"));
  EXPECT_EQ(read_session(open_capture(folder / "new"), 0).frames[0].time_s, 10.5);
}

TEST(CaptureWriter, WithoutCommitNothingIsLeft) {
  const TempFolder folder;
  {
    CaptureWriter writer(folder / "new", calibration());
    writer.add_scan(scan_at(1));
    EXPECT_TRUE(fs::exists(folder / "new.partial/lidar/000000.pcd"));
  }
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

/// Killed at any moment, a writer leaves nothing that reads as a capture.
TEST(CaptureWriter, KilledItLeavesNoCapture) {
  const TempFolder folder;
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    CaptureWriter writer(folder / "new", calibration());
    writer.add_scan(scan_at(1));
    std::ofstream(writer.add_image(1, ".png")) << "not looked at";
    ::kill(::getpid(), SIGKILL);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_FALSE(fs::exists(folder / "new"));
  EXPECT_THAT(input_error([&] { open_capture(folder / "new.partial"); }), HasSubstr("capture.json: no such file"));
  write_small_capture(folder / "new");
  EXPECT_EQ(open_capture(folder / "new").scans.size(), 2U) << "what was left is replaced";
  EXPECT_FALSE(fs::exists(folder / "new.partial"));
}

TEST(CaptureWriter, RefusesWhatWouldNotReadBack) {
  const TempFolder folder;
  fs::create_directory(folder / "there");
  EXPECT_THROW(CaptureWriter(folder / "there", calibration()), OutputError);
  EXPECT_THROW(CaptureWriter(folder / "no/such/place", calibration()), OutputError);
  EXPECT_THROW(CaptureWriter(folder / "new", CaptureCalibration{}), UsageError) << "no camera";
  CaptureWriter writer(folder / "new", calibration());
  writer.add_scan(scan_at(2));
  EXPECT_THROW(writer.add_scan(scan_at(2)), std::invalid_argument);
  writer.add_image(1, ".png");
  EXPECT_THROW(writer.add_image(0.5, ".png"), std::invalid_argument);
  EXPECT_THROW(writer.commit(), UsageError) << "the image was never written";
  EXPECT_FALSE(fs::exists(folder / "new"));
}

}  // namespace capture_writer_test
}  // namespace cmap::testing

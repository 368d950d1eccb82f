#include "cmap/io/unpack_recording.hpp"

#include "cmap/io/lidar_scan_file.hpp"
#include "io/mcap_testing.hpp"

namespace cmap::testing {
namespace unpack_recording_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

RecordedImage raw(std::string_view encoding, int width, int height, std::size_t row_bytes, std::string_view bytes) {
  RecordedImage image;
  image.encoding = encoding;
  image.width = width;
  image.height = height;
  image.row_bytes = row_bytes;
  const std::span<const std::byte> data = bytes_of(bytes);
  image.bytes.assign(data.begin(), data.end());
  return image;
}

TEST(RawImages, EveryEncodingIsRgb) {
  EXPECT_THAT(rgb_of_raw(raw("rgb8", 2, 1, 6, "abcdef")).pixels, ElementsAre(Rgb8{'a', 'b', 'c'}, Rgb8{'d', 'e', 'f'}));
  EXPECT_THAT(rgb_of_raw(raw("bgr8", 1, 2, 4, "abc.def.")).pixels,
              ElementsAre(Rgb8{'c', 'b', 'a'}, Rgb8{'f', 'e', 'd'}));
  EXPECT_THAT(rgb_of_raw(raw("bgra8", 1, 1, 4, "abcd")).pixels, ElementsAre(Rgb8{'c', 'b', 'a'}));
  EXPECT_THAT(rgb_of_raw(raw("mono8", 2, 1, 2, "ab")).pixels, ElementsAre(Rgb8{'a', 'a', 'a'}, Rgb8{'b', 'b', 'b'}));
  EXPECT_THAT(rgb_of_raw(raw("mono16", 1, 1, 2, "ab")).pixels, ElementsAre(Rgb8{'b', 'b', 'b'}));
  EXPECT_THROW(rgb_of_raw(raw("yuv422", 1, 1, 2, "ab")), UnsupportedError);
  EXPECT_THROW(rgb_of_raw(raw("rgb8", 1, 1, 2, "ab")), InputError);
}

TEST(RawImages, BayerPatternsGiveAnEvenColorBack) {
  // Each of the pattern's four pixels measures one color of the same gray-green surface.
  const std::map<char, char> value{{'r', 10}, {'g', 100}, {'b', 30}};
  for (const std::string pattern : {"rggb", "bggr", "gbrg", "grbg"}) {
    std::string bytes;
    for (int y = 0; y < 4; ++y) {
      for (int x = 0; x < 6; ++x) bytes += value.at(pattern[static_cast<std::size_t>(2 * (y % 2) + x % 2)]);
    }
    for (const Rgb8& pixel : rgb_of_raw(raw("bayer_" + pattern + "8", 6, 4, 6, bytes)).pixels) {
      EXPECT_EQ(pixel, (Rgb8{10, 100, 30})) << pattern;
    }
  }
}

std::string cloud(std::uint32_t width, std::uint32_t seconds) {
  std::string data;
  for (std::uint32_t i = 0; i < width; ++i) data += Bytes().put(1.0F, 2.0F, 3.0F).str();
  const std::vector<FieldText> fields{{"x", 0, kPointFloat32}, {"y", 4, kPointFloat32}, {"z", 8, kPointFloat32}};
  return point_cloud2(Wire::kRos1, {1, width, fields, false, 12, 12 * width, data}, seconds, 0);
}

class UnpackRecording : public ::testing::Test {
 protected:
  void SetUp() override {
    rig_.calibration.camera.width = rig_.calibration.camera.height = 10;
    rig_.calibration.camera.fx = rig_.calibration.camera.fy = 10;
    rig_.calibration.imu_time_offset_s = 0.5;
    McapText text;
    text.header()
        .schema(1, "sensor_msgs/Imu")
        .schema(2, "sensor_msgs/PointCloud2")
        .channel(1, 1, "/imu")
        .channel(2, 2, "/points");
    const auto at = [](int seconds) { return static_cast<std::uint64_t>(seconds) * 1'000'000'000; };
    // Scans: two, one without points, one of a time that was. IMU: out of order, one time twice.
    for (const auto& [arrival, points, seconds] :
         {std::tuple(1, 1, 10), {2, 0, 11}, {3, 2, 12}, {4, 3, 12}, {9, 4, 20}}) {
      text.message(2, at(arrival), cloud(static_cast<std::uint32_t>(points), static_cast<std::uint32_t>(seconds)));
    }
    for (const auto& [arrival, seconds] : {std::pair(1, 11U), {2, 10U}, {3, 11U}}) {
      text.message(1, at(arrival), imu_message(Wire::kRos1, 0, 0, 1.0, 0, seconds));
    }
    recording_ = folder_.write("drive.mcap", text.end().file());
  }

  TempFolder folder_;
  std::filesystem::path recording_;
  RecordingConfiguration rig_;
};

TEST_F(UnpackRecording, MakesACaptureAndSaysWhatWasLeftOut) {
  const UnpackedRecording found = unpack_recording(recording_, rig_, folder_ / "capture");
  EXPECT_EQ(found.scans, 3U);
  EXPECT_EQ(found.imu_samples, 2U);
  std::string said;
  for (const Warning& warning : found.warnings) said += warning.message + "\n";
  EXPECT_THAT(said, HasSubstr("1 scans without points"));
  EXPECT_THAT(said, HasSubstr("1 scans that do not come after the one before"));
  EXPECT_THAT(said, HasSubstr("1 IMU samples of a time that another has"));
  EXPECT_THAT(said, HasSubstr("IMU samples were not in the order of their times"));
  EXPECT_THAT(said, HasSubstr("taken for g"));
  const Capture capture = open_capture(folder_ / "capture", {.images = Want::kNo});
  ASSERT_EQ(capture.scans.size(), 3U);
  EXPECT_EQ(capture.scans[1].time_s, 12.0);
  EXPECT_EQ(read_lidar_scan(capture.scans[1].path, 12.0).positions.size(), 2U) << "the first of its time";
  ASSERT_EQ(capture.imu.size(), 2U);
  EXPECT_EQ(capture.imu[0].time_s, 10.5) << "in the clock of the LiDAR";
  EXPECT_NEAR(capture.imu[0].specific_force_mps2.z(), 9.80665, 1e-12);
}

TEST_F(UnpackRecording, APartByArrival) {
  EXPECT_EQ(unpack_recording(recording_, rig_, folder_ / "a", {1.5, 2.0}).scans, 1U)
      << "those that arrive at 3 and 4 s";
  EXPECT_EQ(unpack_recording(recording_, rig_, folder_ / "b", {1.5, std::nullopt}).scans, 2U);
  EXPECT_THROW(unpack_recording(recording_, rig_, folder_ / "c", {100.0, std::nullopt}), InputError);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "c"));
}

}  // namespace unpack_recording_test
}  // namespace cmap::testing

#include "cmap/io/recording.hpp"
#include "io/io_testing.hpp"

namespace cmap::testing {
namespace recording_configuration_test {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr std::string_view kRig =
    R"({"version": 1, "camera": {"model": "pinhole", "width": 64, "height": 48, "K": [50, 50, 31.5, 23.5]},
        "T_imu_lidar": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]], "T_lidar_camera": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]])";

RecordingConfiguration read(std::string_view rest) {
  const TempFolder folder;
  return read_recording_configuration(folder.write("rig.json", std::string(kRig) + std::string(rest) + "}"));
}

std::string refusal_with(std::string_view rest) {
  try {
    read(rest);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(RecordingConfiguration, SaysWhatIsReadAndHow) {
  const RecordingConfiguration rig = read(
      R"(, "imu": {"acceleration_unit": "g"}, "time_offset": {"image_s": -0.1},
         "recording": {"topics": {"lidar": "/l", "imu": "/i"}, "time_reference": {"imu": "/t"}, "point_time_unit": "us"})");
  EXPECT_EQ(rig.options.source(RecordingRole::kLidar).topic, "/l");
  EXPECT_EQ(rig.options.source(RecordingRole::kImu).topic, "/i");
  EXPECT_EQ(rig.options.source(RecordingRole::kImu).time_reference, "/t");
  EXPECT_EQ(rig.options.source(RecordingRole::kImage).topic, "");
  EXPECT_EQ(rig.options.point_time_unit, PointTimeUnit::kMicroseconds);
  EXPECT_EQ(rig.options.acceleration_unit, AccelerationUnit::kG);
  EXPECT_EQ(rig.calibration.image_time_offset_s, -0.1);
  EXPECT_EQ(rig.calibration.camera.fx, 50);
}

TEST(RecordingConfiguration, WhatIsNotSaidIsSeen) {
  const RecordingConfiguration rig = read("");
  EXPECT_EQ(rig.options.acceleration_unit, AccelerationUnit::kAuto);
  EXPECT_EQ(rig.options.point_time_unit, PointTimeUnit::kAuto);
}

TEST(RecordingConfiguration, ARigOfALidarAloneNeedsNoCamera) {
  const TempFolder folder;
  const fs::path path =
      folder.write("rig.json", R"({"version": 1, "T_imu_lidar": [[1,0,0,0],[0,1,0,0],[0,0,1,0.5],[0,0,0,1]],
                      "recording": {"topics": {"lidar": "/l"}}})");
  EXPECT_EQ(read_recording_configuration(path, false).calibration.T_imu_lidar.translation().z(), 0.5);
  EXPECT_THROW(read_recording_configuration(path), InputError);
}

TEST(RecordingConfiguration, WhatIsWrongIsNamed) {
  EXPECT_THAT(refusal_with(R"(, "recording": {"topic": {}})"), HasSubstr("rig.json: unknown key \"recording.topic\""));
  EXPECT_THAT(refusal_with(R"(, "recording": {"topics": {"camera": "/c"}})"), HasSubstr("recording.topics.camera"));
  EXPECT_THAT(refusal_with(R"(, "recording": {"topics": {"imu": ""}})"), HasSubstr("recording.topics.imu is \"\""));
  EXPECT_THAT(refusal_with(R"(, "recording": {"point_time_unit": "min"})"), HasSubstr("one of auto, s, ms, us, ns"));
  EXPECT_THAT(refusal_with(R"(, "recordings": {})"), HasSubstr("recordings"));
}

TEST(RecordingConfiguration, ThoseOfPublicDataSetsAreSound) {
  const char* source = std::getenv("CMAP_SOURCE_DIR");
  std::size_t n = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(source == nullptr ? "." : source) / "configs/recordings")) {
    SCOPED_TRACE(entry.path());
    const RecordingConfiguration rig = read_recording_configuration(entry.path());
    EXPECT_TRUE(rig.warnings.empty()) << "no rotation with a typing error";
    EXPECT_FALSE(rig.options.source(RecordingRole::kLidar).topic.empty());
    // A camera looks where a LiDAR of Livox does, or down along the fan of the VLP-16; it sits within half a meter.
    EXPECT_LT(rig.calibration.T_lidar_camera.translation().norm(), 0.5);
    ++n;
  }
  EXPECT_EQ(n, 6U);
}

}  // namespace recording_configuration_test
}  // namespace cmap::testing

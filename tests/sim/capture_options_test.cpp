#include "cmap/sim/capture_options.hpp"

#include <nlohmann/json.hpp>

#include "cmap/core/error.hpp"
#include "sim/sensor_testing.hpp"

namespace cmap {
namespace capture_options_test {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string refusal(const std::string& json) {
  CaptureOptions options;
  try {
    apply_capture_config(options, json, "here.json");
  } catch (const UsageError& error) {
    return error.what();
  }
  return {};
}

TEST(CaptureOptions, PresetsAreRead) {
  for (const std::string& name : capture_preset_names()) {
    CaptureOptions options;
    EXPECT_NO_THROW(apply_capture_preset(options, name)) << name;
  }
  CaptureOptions options;
  apply_capture_preset(options, "aerial");
  EXPECT_EQ(options.lidar.pattern, LidarPattern::kAviaRosette);
  EXPECT_EQ(options.scene.kind, SceneKind::kAerial);
  EXPECT_EQ(options.mount.lidar_roll_pitch_yaw_deg.y(), 90.0);
  EXPECT_THROW(apply_capture_preset(options, "moon"), UsageError);
}

TEST(CaptureOptions, ComeBackFromTheirJson) {
  for (const std::string& name : capture_preset_names()) {
    CaptureOptions options, again;
    apply_capture_preset(options, name);
    options.predictions.outlier_sessions = {1, 3};
    options.camera.distortion = {0.1, -0.2, 0.0, 0.001};
    options.seed = 77;
    const std::string json = to_json(options).dump();
    apply_capture_config(again, json, "json");
    EXPECT_EQ(to_json(again).dump(), json) << name;
  }
}

TEST(CaptureOptions, EveryNumberCanBeSetByName) {
  CaptureOptions defaults;
  // Each number of every section, one at a time: a field that the description reads into another one would not change.
  const nlohmann::ordered_json all = to_json(defaults);
  for (const auto& [section, fields] : all.items()) {
    if (!fields.is_object()) continue;
    for (const auto& [field, value] : fields.items()) {
      if (!value.is_number()) continue;
      CaptureOptions options;
      const double other = value.get<double>() == 1.0 ? 2.0 : 1.0;
      set_capture_option(options, section + "." + field +
                                      (value.is_number_integer() && field == "width_px" ? "=28"
                                       : other == 1.0                                   ? "=1"
                                                                                        : "=2"));
      nlohmann::ordered_json expected = all, got = to_json(options);
      EXPECT_NE(got[section][field], expected[section][field]) << section << "." << field;
      got[section].erase(field);
      expected[section].erase(field);
      EXPECT_EQ(got, expected) << section << "." << field << " changed another one";
    }
  }
}

TEST(CaptureOptions, ModelsOfLidarsComeFirst) {
  CaptureOptions options;
  apply_capture_config(options, R"({"lidar": {"range_noise_m": 0.5, "model": "mid360"}})", "here");
  EXPECT_EQ(options.lidar.pattern, LidarPattern::kMid360);
  EXPECT_EQ(options.lidar.range_noise_m, 0.5);
  set_capture_option(options, "lidar.model=spinning_32");
  EXPECT_EQ(options.lidar.elevations_deg.size(), 32u);
  set_capture_option(options, "route.name=street");
  EXPECT_EQ(options.route.name, "street");
  set_capture_option(options, "seed=5");
  EXPECT_EQ(options.seed, 5);
}

TEST(CaptureOptions, RefusalsNameSourceSectionAndKey) {
  EXPECT_THAT(refusal(R"({"lidar": {"rnage_noise_m": 1}})"),
              AllOf(HasSubstr("here.json"), HasSubstr("lidar"), HasSubstr("unknown key \"rnage_noise_m\"")));
  EXPECT_THAT(refusal(R"({"ladar": {}})"), HasSubstr("unknown key \"ladar\""));
  EXPECT_THAT(refusal(R"({"imu": {"rate_hz": "fast"}})"), HasSubstr("imu: rate_hz: \"fast\" is not a number"));
  EXPECT_THAT(refusal(R"({"imu": {"rate_hz": -1}})"), HasSubstr("imu: rate_hz: -1 must be above 0"));
  EXPECT_THAT(refusal(R"({"camera": {"width_px": 10.5}})"), HasSubstr("is not a whole number"));
  EXPECT_THAT(refusal(R"({"path": {"turn_with_route": 1}})"), HasSubstr("is neither true nor false"));
  EXPECT_THAT(refusal(R"({"route": {"start_m": [1, 2, 3]}})"), HasSubstr("is not a list of 2 numbers"));
  EXPECT_THAT(refusal(R"({"lidar": {"model": "hesai"}})"), HasSubstr("models are spinning_16"));
  EXPECT_THAT(refusal(R"({"lidar": {"pattern": "round"}})"), HasSubstr("is none of spinning, avia, mid360"));
  EXPECT_THAT(refusal(R"({"scene": {"kind": "town", "furniture": 1}})"), HasSubstr("unknown key \"furniture\""));
  EXPECT_THAT(refusal(R"({"camera": {"format": "gif"}})"), HasSubstr("camera: format: \"gif\" is none of jpg, png"));
  EXPECT_EQ(refusal(R"({"scene": {"furniture": 0.5, "kind": "indoor"}})"), "") << "whatever the order of keys";
  EXPECT_THAT(refusal(R"({"seed": 1.5})"), HasSubstr("seed"));
  EXPECT_THAT(refusal(R"([1])"), HasSubstr("expected a JSON object"));
  EXPECT_THAT(refusal(R"({"imu": 3})"), HasSubstr("imu: expected a JSON object"));
  CaptureOptions options;
  EXPECT_THROW(set_capture_option(options, "imu.rate_hz"), UsageError);
  EXPECT_THROW(set_capture_option(options, "imu.rate=1"), UsageError);
}

TEST(CaptureOptions, CameraLooksForwardByDefaultAndDownWhenPitched) {
  MountOptions mount;
  mount.camera_translation_m.setZero();
  mount.lidar_translation_m.setZero();
  const Eigen::Isometry3d ahead = T_imu_lidar_of(mount) * T_lidar_camera_of(mount);
  EXPECT_TRUE((ahead.linear() * Eigen::Vector3d::UnitZ()).isApprox(Eigen::Vector3d::UnitX()));
  EXPECT_TRUE((ahead.linear() * Eigen::Vector3d::UnitY()).isApprox(-Eigen::Vector3d::UnitZ())) << "image rows go down";
  mount.lidar_roll_pitch_yaw_deg = {0, 90, 0};
  const Eigen::Isometry3d down = T_imu_lidar_of(mount) * T_lidar_camera_of(mount);
  EXPECT_TRUE((down.linear() * Eigen::Vector3d::UnitZ()).isApprox(-Eigen::Vector3d::UnitZ()));
  EXPECT_TRUE((down.linear() * -Eigen::Vector3d::UnitY()).isApprox(Eigen::Vector3d::UnitX())) << "forward is up";
}

}  // namespace capture_options_test
}  // namespace cmap

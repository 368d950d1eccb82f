#include "cmap/io/capture.hpp"

#include "io/capture_testing.hpp"

namespace cmap::testing {
namespace capture_test {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

TEST(Capture, OpensAHandMadeOne) {
  const TempFolder folder;
  CaptureText text;
  text.files["predictions/session_0001/frames.csv"] = "not looked at";
  text.files["predictions/session_0000.npz"] = "not looked at";
  text.files["predictions/session_0000.frames.csv"] = "belongs to the NPZ file";
  text.write_to(folder.path());
  const Capture capture = open_capture(folder.path());
  const CaptureCalibration& calibration = capture.calibration;
  EXPECT_EQ(calibration.camera.projection, CameraProjection::kPinhole);
  EXPECT_EQ(calibration.camera.fy, 26.0);
  EXPECT_EQ(calibration.camera.distortion, (std::vector<double>{0.1, 0, 0, 0}));
  EXPECT_EQ(calibration.T_imu_lidar * Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(-1.5, 1, 2.75));
  EXPECT_EQ(calibration.T_lidar_camera * Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(3, -1, -2));
  EXPECT_EQ(*calibration.T_world_imu_start * Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(3, 7, 10));
  ASSERT_EQ(capture.images.size(), 2U);
  EXPECT_EQ(capture.images[1].time_s, 3.0);
  EXPECT_EQ(capture.images[1].path, folder / "images/b.jpg");
  ASSERT_EQ(capture.scans.size(), 1U);
  EXPECT_EQ(capture.scans[0].time_s, 1.5);
  ASSERT_EQ(capture.imu.size(), 2U);
  EXPECT_EQ(capture.imu[0].time_s, 0.75);
  EXPECT_EQ(capture.imu[0].angular_rate_radps, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(capture.imu[1].specific_force_mps2, Eigen::Vector3d(0.5 * 9.80665, 0, -9.80665));
  EXPECT_EQ(capture.lio.size(), 2U);
  EXPECT_EQ(capture.sessions,
            (std::vector<fs::path>{folder / "predictions/session_0000.npz", folder / "predictions/session_0001"}));
  EXPECT_TRUE(capture.warnings.empty());
}

TEST(Capture, ImuRowsAreSortedAndOfOneTimeTheFirstCounts) {
  CaptureText text;
  text.files["imu.csv"] = "timestamp_s,gx,gy,gz,ax,ay,az\n3,0,0,0,0,0,3\n1,0,0,0,0,0,1\n2,0,0,0,0,0,2\n2,0,0,0,0,0,7\n";
  const Capture capture = text.open();
  std::vector<double> forces_g;
  for (const ImuSample& sample : capture.imu) forces_g.push_back(sample.specific_force_mps2.z() / 9.80665);
  EXPECT_THAT(forces_g, ::testing::ElementsAre(1.0, 2.0, 3.0));
  ASSERT_EQ(capture.warnings.size(), 1U);
  EXPECT_THAT(capture.warnings[0].message, HasSubstr("out of order and are sorted; 1 of 4 rows repeat"));
}

TEST(Capture, ALidarAloneNeedsNoCamera) {
  CaptureText text;
  text.files["capture.json"] = R"({"version":1, "T_imu_lidar":[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]})";
  const TempFolder folder;
  text.write_to(folder.path());
  const Capture capture = open_capture(folder.path(), {.images = Want::kNo, .sessions = Want::kNo});
  EXPECT_EQ(capture.scans.size(), 1U);
  EXPECT_FALSE(capture.calibration.T_world_imu_start.has_value());
  EXPECT_THAT(input_error([&] { open_capture(folder.path()); }), HasSubstr("camera"));
}

TEST(Capture, ImuPosesPredictionsOffsetsAndDistortionAreOptional) {
  CaptureText text;
  text.files.erase("imu.csv");
  text.files.erase("lio.tum");
  text.files["capture.json"] =
      R"({"version":1, "camera":{"model":"fisheye","width":3,"height":2,"K":[1,1,1,1]},
      "T_imu_lidar":[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]], "T_lidar_camera":[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]})";
  const Capture capture = text.open();
  EXPECT_TRUE(capture.imu.empty());
  EXPECT_TRUE(capture.lio.empty());
  EXPECT_TRUE(capture.sessions.empty());
  EXPECT_EQ(capture.images[0].time_s, 1.0);
  EXPECT_EQ(capture.calibration.camera.projection, CameraProjection::kFisheye);
}

/// MARS-LVIG's HKairport calibration as published: -0.0560389 stands for -0.00560389.
TEST(Capture, RotationsAreProjectedWithAWarning) {
  CaptureText text;
  std::string& json = text.files["capture.json"];
  const std::string exact = "[0,-1,0,0.5],[1,0,0,0]";
  json.replace(json.find(exact), exact.size(), "[0,-1,0,0.5],[1,0,0.03,0]");
  const Capture capture = text.open();
  ASSERT_EQ(capture.warnings.size(), 1U);
  EXPECT_EQ(capture.warnings[0].id, "rotation_not_orthonormal");
  EXPECT_THAT(capture.warnings[0].message, HasSubstr("T_imu_lidar deviates from a rotation by 0.03"));
  const Eigen::Matrix3d R = capture.calibration.T_imu_lidar.linear();
  EXPECT_TRUE((R.transpose() * R).isIdentity(1e-14));
  EXPECT_NEAR(R.determinant(), 1.0, 1e-14);
  // The nearest rotation shares the error between the two sides of the product.
  EXPECT_NEAR(R(1, 2), 0.015, 1e-4);
  EXPECT_NEAR(R(2, 0), -0.015, 1e-4);
}

TEST(Capture, SmallDeviationsOfARotationAreSilent) {
  CaptureText text;
  std::string& json = text.files["capture.json"];
  const std::string exact = "[0,-1,0,0.5],[1,0,0,0]";
  json.replace(json.find(exact), exact.size(), "[0,-1,0,0.5],[1,0,0.0005,0]");
  const Capture capture = text.open();
  EXPECT_TRUE(capture.warnings.empty());
  EXPECT_TRUE((capture.calibration.T_imu_lidar.linear().transpose() * capture.calibration.T_imu_lidar.linear())
                  .isIdentity(1e-14));
}

TEST(Capture, EveryMissingFileIsNamed) {
  for (const std::string name : {"capture.json", "images.csv", "lidar.csv", "images/b.jpg", "lidar/a.pcd"}) {
    CaptureText text;
    text.files.erase(name);
    EXPECT_THAT(input_error([&] { text.open(); }), HasSubstr(name));
  }
  EXPECT_THAT(input_error([] { open_capture("/no/such/capture"); }), HasSubstr("/no/such/capture: is no folder"));
}

TEST(Capture, BrokenTablesAreRefusedByFileAndLine) {
  struct Case {
    std::string file, content, message;
  };
  const Case kCases[] = {
      {"images.csv", "timestamp_s,file\n1,images/a.jpg\n1,images/b.jpg\n",
       "line 3: time 1 s is not after the 1 s before it"},
      {"images.csv", "timestamp_s,file\n2,images/a.jpg\n1,images/b.jpg\n", "line 3: time 1 s is not after the 2 s"},
      {"images.csv", "time,file\n1,images/a.jpg\n", "line 1: the columns timestamp_s,file expected"},
      {"images.csv", "timestamp_s,file\n1,\n", "line 2: no file is named"},
      {"images.csv", "timestamp_s,file\n1,images\n", "is no file"},
      {"images.csv", "timestamp_s,file\n", "lists no file"},
      {"images.csv", "timestamp_s,file\n1,images/a.jpg,x\n", "line 2: 3 cells"},
      {"lidar.csv", "timestamp_s,file\ninf,lidar/a.pcd\n", "line 2: timestamp_s is 'inf', not finite"},
      {"lidar.csv", "timestamp_s,file\n1 s,lidar/a.pcd\n", "line 2: timestamp_s is '1 s', not a number"},
      {"imu.csv", "timestamp_s,gx,gy,gz,ax,ay,az\n1,0,0,0,0,0\n", "line 2: 6 cells; the 7"},
      {"imu.csv", "timestamp_s,gx,gy,gz,ax,ay,az\n", "holds no measurement"},
      {"imu.csv", "timestamp_s,ax,ay,az,gx,gy,gz\n", "line 1: the columns timestamp_s,gx,gy,gz,ax,ay,az expected"},
      {"lio.tum", "1 0 0 0 0 0 0 0\n", "none of its 1 rows is a pose"},
      {"lio.tum", "1 0 0 1 0 1 0 2 0 0 1 3\n", "poses without times"},
      {"predictions", "a file", "is no folder"},
  };
  for (const Case& broken : kCases) {
    CaptureText text;
    text.files[broken.file] = broken.content;
    const std::string message = input_error([&] { text.open(); });
    EXPECT_THAT(message, HasSubstr(broken.message));
    EXPECT_THAT(message, HasSubstr(broken.file));
  }
}

TEST(Capture, BrokenCalibrationsAreRefusedByKey) {
  struct Case {
    std::string from, to, message;
  };
  const Case kCases[] = {
      {"\"version\": 1", "\"version\": 2", "version is 2; 1 expected"},
      {"\"version\": 1,", "", "key \"version\" is missing"},
      {"\"T_imu_lidar\"", "\"T_lidar_imu\"", "unknown key \"T_lidar_imu\""},
      {"\"imu\"", "\"IMU\"", "unknown key \"IMU\""},
      {"\"image_s\"", "\"images\"", "unknown key \"time_offset.images\""},
      {"\"model\"", "\"type\"", "unknown key \"camera.type\""},
      {"\"model\": \"pinhole\",", "", "key \"camera.model\" is missing"},
      {"\"pinhole\"", "\"omni\"", "camera.model is \"omni\""},
      {"\"width\": 30", "\"width\": 0", "camera: width is 0"},
      {"\"width\": 30", "\"width\": 30.5", "camera.width: 30.5 is no whole number"},
      {"\"width\": 30", "\"width\": 1e30", "camera.width: 1e+30 is no whole number"},
      {"[25.5, 26,", "[26,", "camera.K: [fx, fy, cx, cy] expected"},
      {"[25.5, 26,", "[-25.5, 26,", "camera: fx is -25.5"},
      {"[25.5, 26,", "[\"a\", 26,", "camera.K: \"a\" is no finite number"},
      {"[0.1, 0, 0, 0]", "[0.1, 0, 0]", "0, 4, 5 or 8 expected"},
      {"[0.1, 0, 0, 0]", "0.1", "camera.distortion: an array of numbers expected"},
      {"[0,-1,0,0.5]", "[0,-1,0]", "T_imu_lidar: a 4x4 matrix of numbers expected"},
      {"[0,-1,0,0.5]", "[0,1,0,0.5]", "T_imu_lidar: no rotation: |R^T R - I| = 0, det R = -1"},
      {"[0,-1,0,0.5]", "[0,-1.2,0,0.5]", "T_imu_lidar: no rotation: |R^T R - I| = 0.44"},
      {"[0,-1,0,0.5]", "[0,-1,0,null]", "T_imu_lidar: null is no finite number"},
      {"[0,0,1,-0.25],[0,0,0,1]", "[0,0,1,0],[0.5,0,-0.25,1]", "T_imu_lidar: the last row is not 0 0 0 1"},
      {"\"g\"", "\"G\"", "imu.acceleration_unit is \"G\""},
      {"\"image_s\": 0.5", "\"image_s\": \"0.5\"", "time_offset.image_s: \"0.5\" is no finite number"},
      {"\"imu_s\"", "\"image_s\"", "key \"image_s\" is given twice"},
      {"{", "", "parse error"},
  };
  for (const Case& broken : kCases) {
    CaptureText text;
    std::string& json = text.files["capture.json"];
    ASSERT_NE(json.find(broken.from), std::string::npos) << broken.from;
    json.replace(json.find(broken.from), broken.from.size(), broken.to);
    const std::string message = input_error([&] { text.open(); });
    EXPECT_THAT(message, HasSubstr(broken.message));
    EXPECT_THAT(message, HasSubstr("capture.json: "));
  }
}

/// image_s is 0.5: recorded 10.5 and 10.75 s are 11 and 11.25 s of the LiDAR's clock, in either form of a session.
TEST(Capture, TheOffsetOfImagesIsThatOfFrames) {
  const TempFolder folder;
  CaptureText text;
  const SessionText session;
  for (const auto& [name, content] : session.files) text.files["predictions/a/" + name] = content;
  text.files["predictions/b.npz"] = session.npz().str();
  text.files["predictions/b.frames.csv"] = text.files["predictions/a/frames.csv"];
  text.write_to(folder.path());
  const Capture capture = open_capture(folder.path());
  for (const std::size_t k : {0U, 1U}) {
    const SessionPredictions read = read_session(capture, k);
    EXPECT_EQ(read.frames[0].time_s, 11.0);
    EXPECT_EQ(read.frames[1].time_s, 11.25);
  }
  EXPECT_EQ(read_session_predictions(capture.sessions[0]).frames[0].time_s, 10.5) << "as recorded";
}

/// Which NPZ file a frames.csv beside several belongs to, nobody can tell.
TEST(Capture, OneTableOfFramesForSeveralNpz) {
  CaptureText text;
  for (const char* name : {"a.npz", "b.npz", "frames.csv"}) text.files[std::string("predictions/") + name] = "x";
  const auto refused = [&] { return input_error([&] { text.open(); }); };
  EXPECT_THAT(refused(), HasSubstr("predictions/frames.csv: of which session?"));
  EXPECT_THAT(refused(), HasSubstr("missing: a.frames.csv, b.frames.csv"));
  text.files["predictions/a.frames.csv"] = "x";
  EXPECT_THAT(refused(), HasSubstr("missing: b.frames.csv"));
  text.files["predictions/b.frames.csv"] = "x";
  EXPECT_EQ(refused(), "");
  text.files.erase("predictions/a.npz");
  text.files.erase("predictions/b.frames.csv");
  text.files["predictions/c/depth.npy"] = "x";
  EXPECT_EQ(refused(), "") << "one NPZ file, and a folder, which has a table of its own";
}

}  // namespace capture_test
}  // namespace cmap::testing

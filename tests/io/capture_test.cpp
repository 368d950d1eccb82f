#include "cmap/io/capture.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <map>

#include "cmap/io/lidar_scan_file.hpp"
#include "io/capture_testing.hpp"

namespace cmap::testing {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

constexpr const char* kCaptureJson = R"({
 "version": 1,
 "camera": {"model": "pinhole", "width": 30, "height": 20, "K": [25.5, 26, 14.5, 9.5], "distortion": [0.1, 0, 0, 0]},
 "T_imu_lidar": [[0,-1,0,0.5],[1,0,0,0],[0,0,1,-0.25],[0,0,0,1]],
 "T_lidar_camera": [[0,0,1,0],[-1,0,0,0],[0,-1,0,0],[0,0,0,1]],
 "T_world_imu_start": [[0,-1,0,5],[1,0,0,6],[0,0,1,7],[0,0,0,1]],
 "imu": {"acceleration_unit": "g"},
 "time_offset": {"image_s": 0.5, "imu_s": -0.25}
})";

/// A small capture, to be broken one file at a time.
struct CaptureText {
  std::map<std::string, std::string> files{
      {"capture.json", kCaptureJson},
      {"images.csv", "timestamp_s,file\n1,images/a.jpg\n2.5,images/b.jpg\n"},
      {"images/a.jpg", "not looked at"},
      {"images/b.jpg", "not looked at"},
      {"lidar.csv", "timestamp_s,file\n1.5,lidar/a.pcd\n"},
      {"lidar/a.pcd", "not looked at"},
      {"imu.csv", "timestamp_s,gx,gy,gz,ax,ay,az\n1,0.1,0.2,0.3,0,0,1\n1.5,0,0,0,0.5,0,-1\n"},
      {"lio.tum", "1 0 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n"}};

  Capture open() const {
    const TempFolder folder;
    write_to(folder.path());
    return open_capture(folder.path());
  }
  void write_to(const fs::path& folder) const {
    for (const auto& [name, content] : files) {
      fs::create_directories((folder / name).parent_path());
      std::ofstream(folder / name, std::ios::binary) << content;
    }
  }
};

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
  EXPECT_EQ(calibration.T_world_imu_start * Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(3, 7, 10));
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
      {"imu.csv", "timestamp_s,gx,gy,gz,ax,ay,az\n1,0,0,0,0,0,1\n0.5,0,0,0,0,0,1\n", "line 3: time 0.5 s is not after"},
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

TEST(Capture, PartsThatNobodyWantsMayBeMissingOrBroken) {
  CaptureText text;
  text.files.erase("images.csv");
  text.files["lidar.csv"] = "no table";
  text.files["imu.csv"] = "no table";
  text.files["predictions"] = "no folder";
  const TempFolder folder;
  text.write_to(folder.path());
  const Capture capture = open_capture(folder.path(), {Want::kNo, Want::kNo, Want::kNo, Want::kNo});
  EXPECT_TRUE(capture.images.empty() && capture.scans.empty() && capture.imu.empty());
  EXPECT_EQ(capture.lio.size(), 2U);
  EXPECT_TRUE(capture.warnings.empty());
}

TEST(Capture, PartsThatAreWantedIfUsable) {
  const CaptureParts parts{.images = Want::kIfUsable, .scans = Want::kIfUsable};
  const auto opened = [&](const CaptureText& text) {
    const TempFolder folder;
    text.write_to(folder.path());
    return open_capture(folder.path(), parts);
  };
  CaptureText text;
  EXPECT_EQ(opened(text).scans.size(), 1U);
  text.files.erase("lidar/a.pcd");
  text.files.erase("images.csv");
  const Capture capture = opened(text);
  EXPECT_TRUE(capture.images.empty() && capture.scans.empty());
  ASSERT_EQ(capture.warnings.size(), 1U);
  EXPECT_EQ(capture.warnings[0].id, "part_left_out");
  EXPECT_THAT(capture.warnings[0].message, HasSubstr("lidar/a.pcd is no file; the run goes on without"));
}

/// With a list of faults, those of such parts are warnings, and what could be read stays.
TEST(Capture, FaultsOfPartsThatAreNotNeededAreWarnings) {
  CaptureText text;
  text.files["images.csv"] += "7,images/missing.jpg\n8,images/gone.jpg\n";
  text.files["imu.csv"] += "nan,0,0,0,0,0,0\n";
  const TempFolder folder;
  text.write_to(folder.path());
  std::vector<std::string> list;
  const CaptureParts parts{.images = Want::kIfUsable, .imu = Want::kIfUsable};
  const Capture capture = open_capture(folder.path(), parts, Faults(list));
  EXPECT_TRUE(list.empty()) << ::testing::PrintToString(list);
  EXPECT_EQ(capture.images.size(), 2U);
  ASSERT_EQ(capture.warnings.size(), 3U);
  EXPECT_THAT(capture.warnings[0].message, HasSubstr("images/missing.jpg is no file; the run goes on without"));
  EXPECT_THAT(capture.warnings[2].message, HasSubstr("imu.csv"));
}

/// All that is wrong at once, and the rest is read.
TEST(Capture, EveryFaultIsListed) {
  CaptureText text;
  std::string& json = text.files["capture.json"];
  json.replace(json.find("\"version\": 1"), 12, "\"version\": 3, \"moon\": 1");
  json.replace(json.find("[25.5, 26,"), 10, "[-25.5, 26,");
  json.replace(json.find("[0,-1,0,0.5]"), 12, "[0,1,0,0.5]");
  text.files["images.csv"] = "timestamp_s,file\n1,images/a.jpg\n1,images/b.jpg\n3,images/c.jpg\nx,images/a.jpg\n";
  text.files["lidar.csv"] = "time,file\n";
  text.files["imu.csv"] += "1,0,0,0,0,0,1\n";
  text.files["lio.tum"] = "moon\n";
  text.files["predictions/a.npz"] = text.files["predictions/b.npz"] = text.files["predictions/frames.csv"] = "x";
  const TempFolder folder;
  text.write_to(folder.path());
  std::vector<std::string> faults;
  const Capture capture = open_capture(folder.path(), {}, Faults(faults));
  const char* const kExpected[] = {"capture.json: unknown key \"moon\"", "capture.json: version is 3",
                                   "capture.json: camera: fx is -25.5",  "capture.json: T_imu_lidar: no rotation",
                                   "images.csv: line 3: time 1 s",       "images.csv: line 4: ",
                                   "images.csv: line 5: timestamp_s",    "lidar.csv: line 1: the columns",
                                   "imu.csv: line 4: time 1 s",          "lio.tum: ",
                                   "predictions/frames.csv: of which"};
  ASSERT_EQ(faults.size(), std::size(kExpected)) << fmt::format("{}", fmt::join(faults, "\n"));
  for (std::size_t i = 0; i < faults.size(); ++i) EXPECT_THAT(faults[i], HasSubstr(kExpected[i]));
  EXPECT_EQ(capture.images.size(), 1U);
  EXPECT_EQ(capture.calibration.image_time_offset_s, 0.5);
  EXPECT_EQ(capture.sessions.size(), 2U);
}

TEST(Capture, ALongListOfFaultyRowsIsCut) {
  CaptureText text;
  for (int i = 0; i < 50; ++i) text.files["lidar.csv"] += fmt::format("{},lidar/missing.pcd\n", i + 2);
  const TempFolder folder;
  text.write_to(folder.path());
  std::vector<std::string> faults;
  open_capture(folder.path(), {}, Faults(faults));
  ASSERT_EQ(faults.size(), 11U);
  EXPECT_THAT(faults.back(), HasSubstr("lidar.csv: line 12: 10 rows are faulty so far; the rest was not read"));
}

TEST(Capture, ACameraOfAnotherSizeIsDoubted) {
  CaptureText text;
  std::string& json = text.files["capture.json"];
  json.replace(json.find("14.5, 9.5"), 9, "320, 240");
  const Capture capture = text.open();
  ASSERT_EQ(capture.warnings.size(), 1U);
  EXPECT_EQ(capture.warnings[0].id, "camera_of_another_size");
  EXPECT_THAT(capture.warnings[0].message,
              HasSubstr("capture.json: camera.K: cx, cy = 320, 240 are not near the middle of a picture of 30 x 20"));
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

}  // namespace
}  // namespace cmap::testing

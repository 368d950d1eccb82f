#include "cmap/io/capture.hpp"
#include "io/capture_testing.hpp"

namespace cmap::testing {
namespace capture_faults_test {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

TEST(CaptureFaults, PartsThatNobodyWantsMayBeMissingOrBroken) {
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

TEST(CaptureFaults, PartsThatAreWantedIfUsable) {
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
TEST(CaptureFaults, FaultsOfPartsThatAreNotNeededAreWarnings) {
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
TEST(CaptureFaults, EveryFaultIsListed) {
  CaptureText text;
  std::string& json = text.files["capture.json"];
  json.replace(json.find("\"version\": 1"), 12, "\"version\": 3, \"moon\": 1");
  json.replace(json.find("[25.5, 26,"), 10, "[-25.5, 26,");
  json.replace(json.find("[0,-1,0,0.5]"), 12, "[0,1,0,0.5]");
  text.files["images.csv"] = "timestamp_s,file\n1,images/a.jpg\n1,images/b.jpg\n3,images/c.jpg\nx,images/a.jpg\n";
  text.files["lidar.csv"] = "time,file\n";
  text.files["imu.csv"] += "x,0,0,0,0,0,1\n";
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
                                   "imu.csv: line 4: timestamp_s",       "lio.tum: ",
                                   "predictions/frames.csv: of which"};
  ASSERT_EQ(faults.size(), std::size(kExpected)) << fmt::format("{}", fmt::join(faults, "\n"));
  for (std::size_t i = 0; i < faults.size(); ++i) EXPECT_THAT(faults[i], HasSubstr(kExpected[i]));
  EXPECT_EQ(capture.images.size(), 1U);
  EXPECT_EQ(capture.calibration.image_time_offset_s, 0.5);
  EXPECT_EQ(capture.sessions.size(), 2U);
}

TEST(CaptureFaults, ALongListOfFaultyRowsIsCut) {
  CaptureText text;
  for (int i = 0; i < 50; ++i) text.files["lidar.csv"] += fmt::format("{},lidar/missing.pcd\n", i + 2);
  const TempFolder folder;
  text.write_to(folder.path());
  std::vector<std::string> faults;
  open_capture(folder.path(), {}, Faults(faults));
  ASSERT_EQ(faults.size(), 11U);
  EXPECT_THAT(faults.back(), HasSubstr("lidar.csv: line 12: 10 rows are faulty so far; the rest was not read"));
}

TEST(CaptureFaults, ACameraOfAnotherSizeIsDoubted) {
  CaptureText text;
  std::string& json = text.files["capture.json"];
  json.replace(json.find("14.5, 9.5"), 9, "320, 240");
  const Capture capture = text.open();
  ASSERT_EQ(capture.warnings.size(), 1U);
  EXPECT_EQ(capture.warnings[0].id, "camera_of_another_size");
  EXPECT_THAT(capture.warnings[0].message,
              HasSubstr("capture.json: camera.K: cx, cy = 320, 240 are not near the middle of a picture of 30 x 20"));
}

}  // namespace capture_faults_test
}  // namespace cmap::testing

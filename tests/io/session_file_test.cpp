#include "cmap/io/session_file.hpp"

#include <limits>

#include "io/capture_testing.hpp"

namespace cmap::testing {
namespace session_file_test {

using ::testing::HasSubstr;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

void expect_hand_made_session(const SessionPredictions& session) {
  EXPECT_EQ(session.width, 3);
  EXPECT_EQ(session.height, 2);
  ASSERT_EQ(session.frame_count(), 2U);
  EXPECT_EQ(session.frames[1].time_s, 10.75);
  EXPECT_EQ(session.frames[1].image_name, "b.jpg");
  EXPECT_EQ(session.frames[1].original_width, 30);
  EXPECT_EQ(session.frames[1].original_height, 20);
  EXPECT_EQ(session.images[4], (Rgb8{84, 91, 98}));
  EXPECT_EQ(session.depth[7], 2.5F);
  EXPECT_EQ(session.depth_confidence[1], 1.25F);
  EXPECT_TRUE(session.T_camera_session[0].matrix().isIdentity(0.0));
  // camera 1 <- session: x' = -y + 0.5, y' = x + 0.25, z' = z - 1
  EXPECT_TRUE((session.T_camera_session[1] * Eigen::Vector3d(1, 2, 3)).isApprox(Eigen::Vector3d(-1.5, 1.25, 2), 1e-15));
  EXPECT_EQ(session.intrinsics[1](0, 0), 4.5);
  EXPECT_EQ(session.intrinsics[1](1, 2), 1.0);
}

TEST(SessionPredictions, ReadsAHandMadeFolder) {
  const SessionPredictions session = SessionText().read();
  expect_hand_made_session(session);
  EXPECT_TRUE(session.world_points.empty());
  EXPECT_TRUE(session.warnings.empty());
}

/// As the network returns them, before anybody squeezed the batch; and in the other byte order.
TEST(SessionPredictions, ReadsABatchOfOne) {
  SessionText text;
  text["images.npy"] = npy_text("'|u1'", "(1, 2, 2, 3, 3)", SessionText::image_bytes());
  text["depth_conf.npy"] = npy_text("'<f4'", "(1, 2, 2, 3)", raw(SessionText::confidence()));
  text["extrinsic.npy"] = npy_text("'<f8'", "(1, 2, 3, 4)", raw(SessionText::poses()));
  text["intrinsic.npy"] = npy_text("'<f8'", "(1, 2, 3, 3)", raw(SessionText::matrices()));
  const auto depth = SessionText::depth();
  Bytes big_endian({}, true);
  for (const float value : depth) big_endian.put(value);
  text["depth.npy"] = npy_text("'>f4'", "(1, 2, 2, 3, 1)", big_endian.str());
  expect_hand_made_session(text.read());
}

/// VGGT's own: float planes, a trailing 1, pickled members, no meta.json; stored, deflated, and with 64-bit sizes.
TEST(SessionPredictions, ReadsPredictionsNpz) {
  SessionText text;
  std::vector<float> planes(36);
  const std::string bytes = SessionText::image_bytes();
  for (std::size_t i = 0; i < 36; ++i) {
    const std::size_t frame = i / 18, channel = i % 18 / 6, pixel = i % 6;
    planes[i] = static_cast<float>(static_cast<U8>(bytes[frame * 18 + pixel * 3 + channel])) / 255.0F;
  }
  text["images.npy"] = npy_text("'<f4'", "(2, 3, 2, 3)", raw(planes));
  text["depth.npy"] = npy_text("'<f4'", "(2, 2, 3, 1)", raw(SessionText::depth()));
  text["pose_enc_list.npy"] = npy_text("'|O'", "()", "\x80\x04N.");
  for (const bool deflate : {false, true}) {
    for (const bool zip64 : {false, true}) {
      ZipText zip = text.npz();
      zip.deflate = deflate;
      zip.zip64 = zip64;
      const TempFolder folder;
      folder.write("predictions.npz", zip.str());
      folder.write("frames.csv", text["frames.csv"]);
      for (const auto& path : {folder.path(), folder / "predictions.npz"}) {
        const SessionPredictions session = read_session_predictions(path);
        expect_hand_made_session(session);
        ASSERT_EQ(session.warnings.size(), 1U);
        EXPECT_EQ(session.warnings[0].id, "skipped_member");
        EXPECT_THAT(session.warnings[0].message, HasSubstr("pose_enc_list"));
      }
    }
  }
}

TEST(SessionPredictions, AnNpzOfManyHasItsOwnFrames) {
  SessionText text;
  const TempFolder folder;
  const auto read = [&] { return read_session_predictions(folder / "session_0000.npz"); };
  folder.write("session_0000.npz", text.npz().str());
  EXPECT_THAT(input_error(read), HasSubstr("session_0000.frames.csv: no such file"));
  folder.write("frames.csv", text["frames.csv"]);
  expect_hand_made_session(read());  // there is no other that it could be of
  folder.write("session_0001.npz", text.npz().str());
  EXPECT_THAT(input_error(read), HasSubstr("session_0000.frames.csv: no such file; the times of the frames of "
                                           "session_0000.npz are expected there, as"));
  folder.write("session_0000.frames.csv", text["frames.csv"]);
  expect_hand_made_session(read());
}

TEST(SessionPredictions, AFolderOfItsOwnSaysWhoseFramesTheyAre) {
  SessionText text;
  const TempFolder folder;
  folder.write("predictions.npz", text.npz().str());
  folder.write("features.npz", "something else");
  folder.write("frames.csv", text["frames.csv"]);
  expect_hand_made_session(read_session_predictions(folder.path()));
}

/// Bicubic resizing oversteps by some percent; -0.05 and 1.05 are black and white.
TEST(SessionPredictions, PictureValuesJustOutsideAreClampedAndCounted) {
  SessionText text;
  std::vector<float> values(36, 0.5F);
  values[0] = -0.05F;
  values[1] = 1.05F;
  values[35] = 1.0000001F;
  text["images.npy"] = npy_text("'<f4'", "(2, 2, 3, 3)", raw(values));
  const SessionPredictions session = text.read();
  EXPECT_EQ(session.images.front(), (Rgb8{0, 255, 128}));
  EXPECT_EQ(session.images.back(), (Rgb8{128, 128, 255}));
  ASSERT_EQ(session.warnings.size(), 1U);
  EXPECT_EQ(session.warnings[0].id, "clamped_picture");
  EXPECT_THAT(session.warnings[0].message, HasSubstr("images.npy: 3 of 36 values are outside [0,1], by up to 0.05"));
}

TEST(SessionPredictions, PicturesOfOtherRangesAreRefusedWithAHint) {
  const auto refusal_of = [](float low, float high) {
    SessionText text;
    std::vector<float> values(36, 0.5F);
    values[3] = low;
    values[4] = high;
    text["images.npy"] = npy_text("'<f4'", "(2, 2, 3, 3)", raw(values));
    return input_error([&] { text.read(); });
  };
  EXPECT_THAT(refusal_of(0.0F, 254.0F),
              HasSubstr("images.npy: holds 254; float images lie in [0,1]; are these 0 to 255"));
  EXPECT_THAT(refusal_of(-0.9F, 0.9F), HasSubstr("holds -0.9; float images lie in [0,1]; are these -1 to 1?"));
  EXPECT_THAT(refusal_of(-2.1F, 2.6F), HasSubstr("holds -2.1; float images lie in [0,1]; were they normalized"));
  EXPECT_THAT(refusal_of(-1e6F, 0.5F), HasSubstr("holds -1e+06; float images lie in [0,1]"));
}

/// The whole 4x4 matrix, as many exporters save it.
TEST(SessionPredictions, ReadsSquarePoses) {
  SessionText text;
  std::vector<double> square;
  const std::vector<double> poses = SessionText::poses();
  for (const int frame : {0, 1}) {
    square.insert(square.end(), poses.begin() + 12 * frame, poses.begin() + 12 * (frame + 1));
    square.insert(square.end(), {0, 0, 0, 1});
  }
  text["extrinsic.npy"] = npy_text("'<f8'", "(2, 4, 4)", raw(square));
  expect_hand_made_session(text.read());
  square[15] = 2.0;
  text["extrinsic.npy"] = npy_text("'<f8'", "(2, 4, 4)", raw(square));
  EXPECT_THAT(input_error([&] { text.read(); }), HasSubstr("extrinsic.npy: frame 0: the last row is not 0 0 0 1"));
}

/// Of the camera's own picture, 30 x 20, in place of the network's 3 x 2; of shares; of a picture turned.
TEST(SessionPredictions, IntrinsicsOfAnotherSizeAreNamed) {
  const auto refusal_of = [](double fx, double fy, double cx, double cy) {
    SessionText text;
    std::vector<double> matrices = SessionText::matrices();
    matrices[9] = fx;
    matrices[11] = cx;
    matrices[13] = fy;
    matrices[14] = cy;
    text["intrinsic.npy"] = npy_text("'<f8'", "(2, 3, 3)", raw(matrices));
    return input_error([&] { text.read(); });
  };
  EXPECT_EQ(refusal_of(4, 5, 0.76, 1.49), "");
  EXPECT_THAT(refusal_of(2, 2.5, 0.75, 0.5), HasSubstr("are they of one of about 2 x 1? Multiply fx and cx by 2, fy"))
      << "half the size";
  EXPECT_THAT(refusal_of(40, 50, 15, 10),
              HasSubstr("intrinsic.npy: frame 1: cx, cy = 15, 10 are not near the middle of "
                        "a picture of 3 x 2 pixels; are they of one of about 30 x 20? "
                        "Multiply fx and cx by 0.1, fy and cy by 0.1"));
  EXPECT_THAT(refusal_of(1.3, 2.5, 0.5, 0.4),
              HasSubstr("are they shares of its size? Multiply fx and cx by 3, fy and cy by 2"));
  EXPECT_THAT(refusal_of(4, 5, 1.5, 1.6), HasSubstr("cx, cy = 1.5, 1.6 are not near the middle"));
  EXPECT_THAT(refusal_of(4, 5, -1, 1), HasSubstr("cx, cy = -1, 1 are not near the middle"));
}

TEST(SessionPredictions, EveryFaultIsListed) {
  SessionText text;
  text["meta.json"] = R"({"version":1,"frames":9,"width":3,"height":2,"pose_convention":"c2w","depth_type":"z"})";
  text["frames.csv"] = "index,timestamp_s,image_name,orig_w,orig_h\n0,x,a.jpg,30,20\n1,2,b.jpg,30,0\n2,3,b.jpg,30,20\n";
  text["images.npy"] = npy_text("'<f4'", "(2, 2, 3, 3)", raw(std::vector<float>(36, 200.0F)));
  text["extrinsic.npy"] = npy_text("'<f8'", "(2, 3)", raw(std::vector<double>(6, 0.0)));
  text.erase("intrinsic.npy");
  const TempFolder folder;
  text.write_to(folder);
  std::vector<std::string> faults;
  read_session_predictions(folder.path(), Faults(faults));
  const char* const kExpected[] = {"meta.json: frames is 9",
                                   "meta.json: pose_convention is \"c2w\"",
                                   "meta.json: key \"intrinsics_pixel_origin\" is missing",
                                   "frames.csv: line 2: timestamp_s is 'x'",
                                   "frames.csv: line 3: an image side of 0",
                                   "frames.csv: 3 frames, but 2 in the arrays",
                                   "images.npy: holds 200",
                                   "extrinsic.npy: has the shape (2, 3)",
                                   "intrinsic.npy: no such file"};
  ASSERT_EQ(faults.size(), std::size(kExpected)) << fmt::format("{}", fmt::join(faults, "\n"));
  for (std::size_t i = 0; i < faults.size(); ++i) EXPECT_THAT(faults[i], HasSubstr(kExpected[i]));
}

/// Without the depth nobody knows the sizes; whether the rest is there can be told.
TEST(SessionPredictions, FaultsBesideAMissingDepth) {
  SessionText text;
  text.erase("depth.npy");
  text.erase("extrinsic.npy");
  text["frames.csv"] = "moon\n";
  const TempFolder folder;
  text.write_to(folder);
  std::vector<std::string> faults;
  read_session_predictions(folder.path(), Faults(faults));
  ASSERT_EQ(faults.size(), 3U) << fmt::format("{}", fmt::join(faults, "\n"));
  EXPECT_THAT(faults[0], HasSubstr("depth.npy: no such file"));
  EXPECT_THAT(faults[1], HasSubstr("frames.csv: line 1: the columns"));
  EXPECT_THAT(faults[2], HasSubstr("extrinsic.npy: no such file"));
}

TEST(SessionPredictions, HalfFloatsAndOtherTypes) {
  SessionText text;
  // 1, 2, 3, 4, 5, 6, 1.5, ... as IEEE half floats.
  const std::vector<U16> half{0x3c00, 0x4000, 0x4200, 0x4400, 0x4500, 0x4600,
                              0x3e00, 0x4100, 0x4300, 0x4480, 0x4580, 0x4680};
  text["depth.npy"] = npy_text("'<f2'", "(2, 2, 3)", raw(half));
  const std::vector<std::int64_t> whole(12, 2);
  text["depth_conf.npy"] = npy_text("'<i8'", "(2, 2, 3)", raw(whole));
  const SessionPredictions session = text.read();
  const std::vector<float> depth = SessionText::depth();
  EXPECT_TRUE(std::equal(depth.begin(), depth.end(), session.depth.begin()));
  EXPECT_EQ(session.depth_confidence[11], 2.0F);
}

/// A session whose frame 0 is not the identity: camera centers and world points move with it.
TEST(SessionPredictions, FirstCameraBecomesTheSessionFrame) {
  SessionText text;
  std::vector<double> poses = SessionText::poses();
  poses[3] = 0.01;  // camera 0 <- old session: a shift by (0.01, 0, 0)
  text["extrinsic.npy"] = npy_text("'<f8'", "(2, 3, 4)", raw(poses));
  std::vector<float> points(36, 1.0F);
  text["world_points.npy"] = npy_text("'<f4'", "(2, 2, 3, 3)", raw(points));
  text["world_points_conf.npy"] = text["depth_conf.npy"];
  const SessionPredictions session = text.read();
  EXPECT_TRUE(session.warnings.empty());
  EXPECT_TRUE(session.T_camera_session[0].matrix().isIdentity(0.0));
  // What old (1, 2, 3) was in camera 1, new (1.01, 2, 3) is.
  EXPECT_TRUE(
      (session.T_camera_session[1] * Eigen::Vector3d(1.01, 2, 3)).isApprox(Eigen::Vector3d(-1.5, 1.25, 2), 1e-14));
  EXPECT_EQ(session.world_points[5], Eigen::Vector3f(1.01F, 1, 1));
  EXPECT_EQ(session.world_points_confidence[5], 4.0F);

  poses[3] = 0.5;  // 0.5 of a median depth of about 4: no longer near
  text["extrinsic.npy"] = npy_text("'<f8'", "(2, 3, 4)", raw(poses));
  ASSERT_EQ(text.read().warnings.size(), 1U);
  EXPECT_EQ(text.read().warnings[0].id, "first_camera_not_identity");
}

TEST(SessionPredictions, PixelsWithoutDepthAreMarkedAndCounted) {
  SessionText text;
  std::vector<float> depth = SessionText::depth(), confidence = SessionText::confidence();
  depth[0] = 0.0F;
  depth[1] = kNaN;
  depth[2] = kInfinity;
  confidence[3] = kNaN;
  confidence[4] = 0.5F;
  text["depth.npy"] = npy_text("'<f4'", "(2, 2, 3)", raw(depth));
  text["depth_conf.npy"] = npy_text("'<f4'", "(2, 2, 3)", raw(confidence));
  const SessionPredictions session = text.read();
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(session.depth[i], 0.0F);
    EXPECT_EQ(session.depth_confidence[i], 0.0F);
  }
  EXPECT_EQ(session.depth[4], 5.0F);
  ASSERT_EQ(session.warnings.size(), 2U);
  EXPECT_EQ(session.warnings[0].id, "invalid_depth");
  EXPECT_THAT(session.warnings[0].message, HasSubstr("4 of 12 pixels"));
  EXPECT_EQ(session.warnings[1].id, "confidence_below_one");
  EXPECT_THAT(session.warnings[1].message, HasSubstr("1 of 12"));
}

TEST(SessionPredictions, PointsThatAreNotFiniteAreMarkedAndCounted) {
  SessionText text;
  std::vector<float> points(36, 2.0F);
  points[4] = kNaN;
  text["world_points.npy"] = npy_text("'<f4'", "(2, 2, 3, 3)", raw(points));
  text["world_points_conf.npy"] = text["depth_conf.npy"];
  const SessionPredictions session = text.read();
  EXPECT_EQ(session.world_points_confidence[1], 0.0F);
  EXPECT_EQ(session.world_points[1], Eigen::Vector3f::Zero());
  EXPECT_EQ(session.world_points_confidence[2], 1.5F);
  ASSERT_EQ(session.warnings.size(), 1U);
  EXPECT_THAT(session.warnings[0].message, HasSubstr("1 of 12 points"));
}

/// One thing broken, and what must be said about it.
struct Broken {
  std::string file;
  std::string content;
  std::string message;
};

std::string poses_with(std::size_t place, double value) {
  std::vector<double> poses = SessionText::poses();
  poses[place] = value;
  return npy_text("'<f8'", "(2, 3, 4)", raw(poses));
}

std::string matrices_with(std::size_t place, double value) {
  std::vector<double> matrices = SessionText::matrices();
  matrices[place] = value;
  return npy_text("'<f8'", "(2, 3, 3)", raw(matrices));
}

std::string depth_with(float value) {
  std::vector<float> depth = SessionText::depth();
  depth[7] = value;
  return npy_text("'<f4'", "(2, 2, 3)", raw(depth));
}

std::vector<Broken> broken_arrays() {
  const std::string depth = raw(SessionText::depth());
  const std::string confidence = raw(SessionText::confidence());
  return {
      {"depth.npy", npy_text("'<f4'", "(2, 1, 2, 3)", depth), "has the shape (2, 1, 2, 3): a batch of 2"},
      {"depth.npy", npy_text("'|O'", "(2, 2, 3)", depth), "pickled Python objects"},
      {"depth.npy", npy_text("'<c8'", "(2, 2, 3)", depth + depth), "holds <c8; plain numbers expected"},
      {"depth.npy", npy_text("[('x', '<f4')]", "(2, 2, 3)", depth), "holds records of x; plain numbers"},
      {"depth.npy", npy_text("'<f4'", "(2, 2, 3)", depth, "False", 4), "NPY version 4.0"},
      {"depth.npy", npy_text("'<f4'", "(2, 2, 3)", depth.substr(4)), "truncated: an array of shape (2, 2, 3)"},
      {"depth.npy", npy_text("'<f4'", "(2, 2, 3)", depth + "x"), "1 bytes follow"},
      {"depth.npy", npy_text("'<f4'", "(2, 6)", depth), "has the shape (2, 6); (0, 0, 0) expected"},
      {"depth.npy", npy_text("'<f4'", "(0, 2, 3)", ""), "no frame or no pixel"},
      {"depth.npy", npy_text("'<f4'", "(4611686018427387904, 4, 4)", depth), "the shape is absurd"},
      {"depth.npy", "\x93NUMPX", "truncated: the start of an NPY file"},
      {"depth.npy", "no array at all", "is no NPY file"},
      {"depth.npy", depth_with(-1.0F), "-1 at frame 1, row 0, column 1; depths are positive"},
      {"depth.npy", npy_text("'<f4'", "(2, 2, 3)", std::string(48, '\0')), "no pixel has a finite positive depth"},
      {"depth_conf.npy", npy_text("'<f4'", "(2, 3, 2)", confidence), "has the shape (2, 3, 2); (2, 2, 3) expected"},
      {"depth_conf.npy", npy_text("'<f4'", "(1, 2, 3)", confidence.substr(24)), "(1, 2, 3); (2, 2, 3) expected"},
      {"images.npy", npy_text("'|u1'", "(1, 2, 3, 3)", std::string(18, '\0')),
       "(1, 2, 3, 3); (2, 2, 3, 3) or (2, 3, 2, 3)"},
      {"images.npy", npy_text("'<f4'", "(2, 2, 3, 3)", raw(std::vector<float>(36, 200.0F))), "holds 200; float images"},
      {"images.npy", npy_text("'<f4'", "(2, 2, 3, 3)", raw(std::vector<float>(36, kNaN))), "holds nan; float images"},
      {"extrinsic.npy", npy_text("'<f8'", "(1, 3, 4)", raw(SessionText::poses()).substr(96)),
       "(1, 3, 4); (2, 3, 4) expected"},
      {"extrinsic.npy", poses_with(12, 0.1), "frame 1: no rotation and translation"},
      {"extrinsic.npy", poses_with(22, -1.0), "frame 1: no rotation and translation"},
      {"extrinsic.npy", poses_with(15, std::numeric_limits<double>::infinity()), "frame 1: no rotation"},
      {"intrinsic.npy", npy_text("'<f8'", "(1, 3, 3)", raw(SessionText::matrices()).substr(72)),
       "(1, 3, 3); (2, 3, 3) expected"},
      {"intrinsic.npy", matrices_with(9, 0.0), "frame 1: no camera matrix"},
      {"intrinsic.npy", matrices_with(3, 0.2), "frame 0: no camera matrix"},
      {"world_points.npy", npy_text("'<f4'", "(2, 2, 3, 3)", raw(std::vector<float>(36, 1.0F))),
       "world_points_conf.npy: no such file"},
  };
}

TEST(SessionPredictions, BrokenArraysAreRefusedByName) {
  for (const Broken& broken : broken_arrays()) {
    SessionText text;
    text[broken.file] = broken.content;
    const std::string message = input_error([&] { text.read(); });
    EXPECT_THAT(message, HasSubstr(broken.message));
    EXPECT_THAT(message, HasSubstr(broken.file.substr(0, 12)));
  }
}

/// The same in an NPZ file: the message names file and member.
TEST(SessionPredictions, BrokenMembersAreRefusedByName) {
  for (const Broken& broken : broken_arrays()) {
    if (broken.file == "world_points.npy") continue;
    SessionText text;
    text[broken.file] = broken.content;
    const TempFolder folder;
    folder.write("predictions.npz", text.npz().str());
    folder.write("frames.csv", text["frames.csv"]);
    const std::string message = input_error([&] { read_session_predictions(folder.path()); });
    EXPECT_THAT(message, HasSubstr(broken.message));
    EXPECT_THAT(message, HasSubstr("predictions.npz: " + broken.file));
  }
}

TEST(SessionPredictions, BrokenTextsAreRefusedByName) {
  const std::string header = "index,timestamp_s,image_name,orig_w,orig_h\n", meta = SessionText()["meta.json"];
  const auto changed = [&](std::string_view from, std::string_view to) {
    std::string text = meta;
    return text.replace(text.find(from), from.size(), to);
  };
  const Broken kCases[] = {
      {"frames.csv", "timestamp_s\n1\n2\n", "line 1: the columns index,timestamp_s,image_name,orig_w,orig_h expected"},
      {"frames.csv", header + "0,1,a.jpg,30,20\n", "1 frames, but 2 in the arrays"},
      {"frames.csv", header + "0,2,a.jpg,30,20\n1,1,b.jpg,30,20\n", "line 3: time 1 s is not after the 2 s"},
      {"frames.csv", header + "0,1,a.jpg,30,20\n1,1,b.jpg,30,20\n", "line 3: time 1 s is not after the 1 s"},
      {"frames.csv", header + "0,1,a.jpg,30,20\n2,2,b.jpg,30,20\n", "line 3: index 2; 1 expected"},
      {"frames.csv", header + "0,x,a.jpg,30,20\n1,2,b.jpg,30,20\n", "line 2: timestamp_s is 'x', not a number"},
      {"frames.csv", header + "0,nan,a.jpg,30,20\n1,2,b.jpg,30,20\n", "line 2: timestamp_s is 'nan', not finite"},
      {"frames.csv", header + "0,1,a.jpg,30\n1,2,b.jpg,30,20\n", "line 2: 4 cells"},
      {"frames.csv", header + "0,1,a.jpg,30,0\n1,2,b.jpg,30,20\n", "line 2: an image side of 0 pixels"},
      {"frames.csv", "", "the file is empty"},
      {"meta.json", changed("\"version\":1", "\"version\":2"), "\"version\": 1 expected"},
      {"meta.json", changed("\"frames\":2", "\"frames\":3"), "frames is 3, but that of the depth is 2"},
      {"meta.json", changed("\"width\":3", "\"width\":4"), "width is 4"},
      {"meta.json", changed("\"height\":2,", ""), "key \"height\" is missing"},
      {"meta.json", changed("opencv_cam_from_world", "opencv_world_from_cam"), "pose_convention is \"opencv_world"},
      {"meta.json", changed("\"z\"", "\"range\""), "depth_type is \"range\"; \"z\" expected"},
      {"meta.json", changed("integer_center", "half_center"), "intrinsics_pixel_origin is \"half_center\""},
      {"meta.json", "{", "parse error at line 1"},
      {"meta.json", "[1]", "an object expected"},
  };
  for (const Broken& broken : kCases) {
    SessionText text;
    text[broken.file] = broken.content;
    const std::string message = input_error([&] { text.read(); });
    EXPECT_THAT(message, HasSubstr(broken.message));
    EXPECT_THAT(message, HasSubstr(broken.file));
  }
}

TEST(SessionPredictions, EveryMissingPartIsNamed) {
  const SessionText whole;
  for (const auto& [name, content] : whole.files) {
    SessionText text;
    text.erase(name);
    EXPECT_THAT(input_error([&] { text.read(); }), HasSubstr(name + ": no such file"));
    if (!name.ends_with(".npy")) continue;
    const TempFolder folder;
    folder.write("predictions.npz", text.npz().str());
    folder.write("frames.csv", text["frames.csv"]);
    EXPECT_THAT(input_error([&] { read_session_predictions(folder.path()); }),
                HasSubstr("predictions.npz: the member " + name + " is missing"));
  }
  EXPECT_THAT(input_error([] { read_session_predictions("/no/such/session"); }), HasSubstr("no such file or folder"));
}

TEST(SessionPredictions, WrittenAndReadBackIsIdentical) {
  SessionText text;
  text["world_points.npy"] = npy_text("'<f4'", "(2, 2, 3, 3)", raw(std::vector<float>(36, 0.1F)));
  text["world_points_conf.npy"] = text["depth_conf.npy"];
  const SessionPredictions session = text.read();
  const TempFolder folder;
  write_session_predictions(session, folder / "copy");
  EXPECT_FALSE(std::filesystem::exists(folder / "copy.partial"));
  const SessionPredictions copy = read_session_predictions(folder / "copy");
  expect_hand_made_session(copy);
  EXPECT_EQ(copy.images, session.images);
  EXPECT_EQ(copy.depth, session.depth);
  EXPECT_EQ(copy.depth_confidence, session.depth_confidence);
  EXPECT_EQ(copy.world_points, session.world_points);
  EXPECT_EQ(copy.world_points_confidence, session.world_points_confidence);
  EXPECT_EQ(copy.intrinsics, session.intrinsics);
  // An existing folder is somebody's data.
  EXPECT_THROW(write_session_predictions(session, folder / "copy"), OutputError);
}

TEST(SessionPredictions, WrittenWholeOrNotAtAll) {
  SessionPredictions session = SessionText().read();
  const TempFolder folder;
  session.frames[1].image_name = "a,b.jpg";
  EXPECT_THROW(write_session_predictions(session, folder / "new"), UsageError);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  session.depth.pop_back();
  EXPECT_THROW(write_session_predictions(session, folder / "new"), std::invalid_argument);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(PointMap, ReadsPicturesAndLists) {
  const TempFolder folder;
  const std::vector<double> points{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, static_cast<double>(kNaN)};
  const std::string mask("\x01\x00\x01\x01", 4);
  for (const bool picture : {false, true}) {
    ZipText zip;
    zip.deflate = true;
    zip.members = {{"pointcloud.npy", npy_text("'<f8'", picture ? "(2, 2, 3)" : "(4, 3)", raw(points))},
                   {"mask.npy", npy_text("'|b1'", picture ? "(2, 2)" : "(4,)", mask)}};
    const PointMap map = read_point_map(folder.write("12.25.npz", zip.str()));
    EXPECT_EQ(map.time_s, 12.25);
    EXPECT_EQ(map.width, picture ? 2 : 4);
    EXPECT_EQ(map.height, picture ? 2 : 1);
    EXPECT_EQ(map.points[1], Eigen::Vector3f(4, 5, 6));
    EXPECT_EQ(map.mask, (Array<U8>{1, 0, 1, 0})) << "the last point is not finite";
  }
}

TEST(PointMap, SaysWhatIsWrong) {
  const TempFolder folder;
  const auto refusal_of = [&](std::string_view name, std::string_view points_shape, std::string_view mask_shape) {
    ZipText zip;
    zip.members = {{"pointcloud.npy", npy_text("'<f4'", points_shape, std::string(48, '\0'))},
                   {"mask.npy", npy_text("'|b1'", mask_shape, std::string(4, '\1'))}};
    const auto path = folder.write(name, zip.str());
    return input_error([&] { read_point_map(path); });
  };
  EXPECT_EQ(refusal_of("1.npz", "(4, 3)", "(4,)"), "");
  EXPECT_THAT(refusal_of("frame.npz", "(4, 3)", "(4,)"), HasSubstr("the name is no time stamp"));
  EXPECT_THAT(refusal_of("1.npz", "(3, 4)", "(4,)"), HasSubstr("pointcloud.npy: has the shape (3, 4)"));
  EXPECT_THAT(refusal_of("1.npz", "(12,)", "(4,)"), HasSubstr("pointcloud.npy: has the shape (12,)"));
  EXPECT_THAT(refusal_of("1.npz", "(2, 2, 3)", "(4,)"), HasSubstr("mask.npy: has the shape (4,); (2, 2) expected"));
}

}  // namespace session_file_test
}  // namespace cmap::testing

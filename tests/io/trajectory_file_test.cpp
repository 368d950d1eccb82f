#include "cmap/io/trajectory_file.hpp"

#include "io/io_testing.hpp"

namespace cmap::testing {
namespace trajectory_file_test {

using ::testing::HasSubstr;

TrajectoryFile read_content(std::string_view content) {
  const TempFolder folder;
  return read_trajectory(folder.write("poses.tum", content));
}

/// Of a file that is read without a word.
Trajectory poses_of(std::string_view content) {
  const TrajectoryFile file = read_content(content);
  EXPECT_TRUE(file.warnings.empty()) << content;
  EXPECT_EQ(file.rows, file.poses.size());
  return file.poses;
}

std::string only_warning(const TrajectoryFile& file) {
  EXPECT_EQ(file.warnings.size(), 1U);
  return file.warnings.empty() ? "" : file.warnings[0].message;
}

std::vector<double> times_of(const Trajectory& trajectory) {
  std::vector<double> times_s;
  for (const StampedPose& pose : trajectory) times_s.push_back(pose.time_s);
  return times_s;
}

template <class Read>
std::string input_error(Read&& read) {
  try {
    read();
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

/// A quarter turn about z.
void expect_quarter_turn(const StampedPose& pose) {
  EXPECT_TRUE((pose.rotation * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY(), 1e-15));
  EXPECT_TRUE((pose.rotation * Eigen::Vector3d::UnitZ()).isApprox(Eigen::Vector3d::UnitZ(), 1e-15));
}

TEST(TrajectoryFile, ReadsPosesCommentsAndAnyLengthOfQuaternion) {
  const Trajectory t = poses_of("# time x y z qx qy qz qw\n\n1.5 1 2 3 0 0 0 1\r\n2.5\t4  5 6 0 0 2 2 # turn\n");
  ASSERT_EQ(t.size(), 2u);
  EXPECT_EQ(t[0].time_s, 1.5);
  EXPECT_EQ(t[0].position, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(t[0].rotation.coeffs(), Eigen::Vector4d(0, 0, 0, 1));
  EXPECT_EQ(t[1].position, Eigen::Vector3d(4, 5, 6));
  expect_quarter_turn(t[1]);
}

TEST(TrajectoryFile, StampsKeepMicroseconds) {
  EXPECT_EQ(poses_of("1305031102.175304 0 0 0 0 0 0 1")[0].time_s, 1305031102.175304);
}

/// One pose, a quarter turn about z at (4, 5, 6) and 2.5 s, as different headers name it.
TEST(TrajectoryFile, ColumnsByTheirNames) {
  for (const char* text :
       {"timestamp,tx,ty,tz,qw,qx,qy,qz\n2.5,4,5,6,1,0,0,1\n", "# time,x,y,z,qw,qx,qy,qz\n2.5,4,5,6,1,0,0,1\n",
        "qx qy qz qw px py pz t\n0 0 1 1 4 5 6 2.5\n",
        "\"Time\";\"X\";\"Y\";\"Z\";\"Qx\";\"Qy\";\"Qz\";\"Qw\"\n2.5;4;5;6;0;0;1;1\n",
        "#sec,nsec,x,y,z,qx,qy,qz,qw\n2,500000000,4,5,6,0,0,1,1\n",
        "header.stamp.secs,header.stamp.nsecs,x,y,z,qx,qy,qz,qw\n2,500000000,4,5,6,0,0,1,1\n",
        ",t,x,y,z,qx,qy,qz,qw\n0,2.5,4,5,6,0,0,1,1\n", "stamp_nsec x y z qx qy qz qw\n2500000000 4 5 6 0 0 1 1\n",
        "# timestamp [s] tx [m] ty [m] tz [m] qx [-] qy [-] qz [-] qw [-]\n2.5 4 5 6 0 0 1 1\n",
        "timestamp_ns,p_x,p_y,p_z,q_x,q_y,q_z,q_w,v_x,v_y,v_z\n2500000000,4,5,6,0,0,1,1,nan,nan,nan\n",
        "%time,field.header.seq,field.header.stamp,field.header.frame_id,field.pose.position.x,field.pose.position.y,"
        "field.pose.position.z,field.pose.orientation.x,field.pose.orientation.y,field.pose.orientation.z,"
        "field.pose.orientation.w\n9,0,2.5,world,4,5,6,0,0,1,1\n",
        "#timestamp_ms,p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z [],\n"
        "2500, 4, 5, 6, 1, 0, 0, 1,\n"}) {
    const Trajectory t = poses_of(text);
    ASSERT_EQ(t.size(), 1U) << text;
    EXPECT_EQ(t[0].time_s, 2.5) << text;
    EXPECT_EQ(t[0].position, Eigen::Vector3d(4, 5, 6)) << text;
    expect_quarter_turn(t[0]);
  }
}

TEST(TrajectoryFile, EurocGroundTruthWithAndWithoutItsHeader) {
  const std::string header =
      "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z [], "
      "v_RS_R_x [m s^-1], v_RS_R_y [m s^-1], v_RS_R_z [m s^-1], b_w_RS_S_x [rad s^-1], b_w_RS_S_y [rad s^-1], "
      "b_w_RS_S_z [rad s^-1], b_a_RS_S_x [m s^-2], b_a_RS_S_y [m s^-2], b_a_RS_S_z [m s^-2]\r\n";
  const std::string row = "1403636580500000000,4,5,6,1,0,0,1,0.1,0.2,0.3,0.4,0.5,0.6,0.7,0.8,0.9\r\n";
  for (const std::string& text : {header + row, row}) {
    const TrajectoryFile file = read_content(text);
    ASSERT_EQ(file.poses.size(), 1U);
    EXPECT_EQ(file.poses[0].time_s, 1403636580.5);
    EXPECT_EQ(file.poses[0].position, Eigen::Vector3d(4, 5, 6));
    expect_quarter_turn(file.poses[0]);
    EXPECT_THAT(only_warning(file), HasSubstr("times are read as nanoseconds"));
  }
}

TEST(TrajectoryFile, TimesAreMadeSecondsAndSaid) {
  const std::pair<const char*, const char*> kUnits[] = {{"1403636580500000000.000", "nanoseconds"},
                                                        {"1403636580500000", "microseconds"},
                                                        {"1403636580500", "milliseconds"}};
  for (const auto& [time, name] : kUnits) {
    const TrajectoryFile file = read_content(std::string(time) + " 0 0 0 0 0 0 1\n");
    EXPECT_EQ(file.poses[0].time_s, 1403636580.5);
    EXPECT_THAT(only_warning(file), HasSubstr(name));
    EXPECT_THAT(only_warning(file), HasSubstr("poses.tum"));
  }
  // Nanoseconds from a start of zero cannot be told from seconds, but nobody records a pose every 28 hours.
  const TrajectoryFile relative = read_content("0 0 0 0 0 0 0 1\n100000000 1 0 0 0 0 0 1\n200000000 2 0 0 0 0 0 1\n");
  EXPECT_EQ(times_of(relative.poses), (std::vector<double>{0, 1e8, 2e8}));
  EXPECT_THAT(only_warning(relative), HasSubstr("more than a day"));
}

TEST(TrajectoryFile, CommasBetweenNumbersOrWithin) {
  expect_quarter_turn(poses_of("2.5,4,5,6,0,0,1,1\n")[0]);
  expect_quarter_turn(poses_of("2.5, 4, 5, 6, 0, 0, 1, 1,\n")[0]);
  expect_quarter_turn(poses_of("2.5;4;5;6;0;0;1;1;\n")[0]);
  for (const char* text : {"2,5;4;5,25;6;0;0;1;1\n", "2,5 4,0 5,25 6,0 0,0 0,0 1,0 1,0\n"}) {
    const TrajectoryFile file = read_content(text);
    EXPECT_EQ(file.poses[0].time_s, 2.5);
    EXPECT_EQ(file.poses[0].position, Eigen::Vector3d(4, 5.25, 6));
    expect_quarter_turn(file.poses[0]);
    EXPECT_THAT(only_warning(file), HasSubstr("commas are read as decimal ones"));
  }
}

TEST(TrajectoryFile, ByteOrderMarkAndLineEnds) {
  for (const char* text : {"\xEF\xBB\xBF"
                           "2.5 4 5 6 0 0 1 1\n3 4 5 6 0 0 1 1\n",
                           "2.5 4 5 6 0 0 1 1\r3 4 5 6 0 0 1 1\r", "2.5 4 5 6 0 0 1 1 \t\r\n3 4 5 6 0 0 1 1\r\n\r\n"}) {
    EXPECT_EQ(times_of(poses_of(text)), (std::vector<double>{2.5, 3})) << text;
  }
}

TEST(TrajectoryFile, CommasWithoutNamesMayBeEurocs) {
  const TrajectoryFile file = read_content("1403636580500000000,4,5,6,0,0,1,1\n");
  ASSERT_EQ(file.warnings.size(), 2U);
  EXPECT_EQ(file.warnings[1].id, "trajectory_quaternion_order");
  expect_quarter_turn(file.poses[0]);
}

TEST(TrajectoryFile, LostRowsAreLeftOutAndCounted) {
  const TrajectoryFile file = read_content(
      "1 0 0 0 0 0 0 1\n2 nan nan nan nan nan nan nan\n3 1.#QNAN 0 0 0 0 0 1\n4 0 0 0 0 0 0 0\n5 -nan(ind) 0 0 0 0 0 "
      "1\n"
      "6 nan nan nan 0 0 0 0\nnan 0 0 0 0 0 0 1\n7 inf 0 0 0 0 0 1\n8 0 0 0 0 0 0 1\n");
  EXPECT_EQ(times_of(file.poses), (std::vector<double>{1, 8}));
  EXPECT_EQ(file.rows, 9U);
  ASSERT_EQ(file.warnings.size(), 2U);
  EXPECT_THAT(file.warnings[0].message, HasSubstr("6 of 9 rows left out: not finite"));
  EXPECT_THAT(file.warnings[1].message, HasSubstr("1 of 9 rows left out: a quaternion of zero"));
}

TEST(TrajectoryFile, EmptyCellsAreLostRows) {
  const TrajectoryFile file = read_content("time,x,y,z,qx,qy,qz,qw\n1,0,0,0,0,0,0,1\n2,,,,,,,\n3,,,,0,0,0,1\n");
  EXPECT_EQ(times_of(file.poses), (std::vector<double>{1}));
  EXPECT_THAT(only_warning(file), HasSubstr("2 of 3 rows left out: not finite"));
}

TEST(TrajectoryFile, OnePoseForEachTime) {
  const TrajectoryFile repeated = read_content("1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n2 5 0 0 0 0 0 1\n2 5 0 0 0 0 0 2\n");
  EXPECT_EQ(times_of(repeated.poses), (std::vector<double>{1, 2}));
  EXPECT_THAT(only_warning(repeated), HasSubstr("2 repeated poses are left out"));
  const TrajectoryFile other = read_content("1 0 0 0 0 0 0 1\n1 3 0 0 0 0 0 1\n2 5 0 0 0 0 0 1\n");
  EXPECT_EQ(times_of(other.poses), (std::vector<double>{1, 2}));
  EXPECT_EQ(other.poses[0].position.x(), 0.0);
  EXPECT_THAT(only_warning(other), HasSubstr("a row has the time of an earlier row but another pose"));
}

TEST(TrajectoryFile, WhatIsLeftOutOfATimeIsKept) {
  const TrajectoryFile file =
      read_content("3 5 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n3 6 0 0 0 0 0 1\n1 2 0 0 0 0 0 1\n3 7 0 0 0 0 0 1\n");
  EXPECT_EQ(times_of(file.poses), (std::vector<double>{1, 3}));
  EXPECT_EQ(times_of(file.repeated), (std::vector<double>{1, 3, 3}));
  std::vector<double> x;
  for (const StampedPose& pose : with_repeated(file)) x.push_back(pose.position.x());
  EXPECT_EQ(x, (std::vector<double>{1, 2, 5, 6, 7})) << "by time, else as in the file";
}

TEST(TrajectoryFile, UnorderedRowsAreSorted) {
  const TrajectoryFile file = read_content("3 3 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n2 2 0 0 0 0 0 1\n1 7 0 0 0 0 0 1\n");
  EXPECT_EQ(times_of(file.poses), (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(file.poses[0].position.x(), 1.0);  // the first of the file
  ASSERT_EQ(file.warnings.size(), 2U);
  EXPECT_THAT(file.warnings[0].message, HasSubstr("2 rows are before the row above in time"));
}

const std::string kKitti = "1 0 0 1 0 1 0 2 0 0 1 3\n0 -1 0 4 1 0 0 5 0 0 1 6\n";

TEST(TrajectoryFile, MatricesHaveNoTimesOfTheirOwn) {
  for (const std::string& text :
       {kKitti, std::string("1 0 0 1 0 1 0 2 0 0 1 3 0 0 0 1\n0 -1 0 4 1 0 0 5 0 0 1 6 0 0 1e-9 1\n"),
        std::string("0 0 1\n1 0 0 1\n0 1 0 2\n0 0 1 3\n0 0 0 1\n1 1 2\n0 -1 0 4\n1 0 0 5\n0 0 1 6\n0 0 0 1\n")}) {
    const TrajectoryFile file = read_content(text);
    EXPECT_FALSE(file.has_times);
    EXPECT_TRUE(file.warnings.empty());
    ASSERT_EQ(file.poses.size(), 2u);
    EXPECT_EQ(file.poses[0].position, Eigen::Vector3d(1, 2, 3));
    EXPECT_EQ(file.poses[1].time_s, 1.0);
    EXPECT_EQ(file.poses[1].position, Eigen::Vector3d(4, 5, 6));
    expect_quarter_turn(file.poses[1]);
  }
}

/// MulRan: nanoseconds and 12 numbers; KITTI-360's: a frame and 16.
TEST(TrajectoryFile, MatricesAfterATime) {
  const TrajectoryFile mulran = read_content("1561000444500000000,0,-1,0,4,1,0,0,5,0,0,1,6\n");
  EXPECT_TRUE(mulran.has_times);
  EXPECT_EQ(mulran.poses[0].time_s, 1561000444.5);
  EXPECT_EQ(mulran.poses[0].position, Eigen::Vector3d(4, 5, 6));
  expect_quarter_turn(mulran.poses[0]);
  const Trajectory frames = poses_of("7 0 -1 0 4 1 0 0 5 0 0 1 6 0 0 0 1\n");
  EXPECT_EQ(frames[0].time_s, 7.0);
  expect_quarter_turn(frames[0]);
}

TEST(TrajectoryFile, PairsOfWhichOneNeedsTimes) {
  const TempFolder folder;
  const auto kitti = folder.write("kitti.txt", kKitti), other = folder.write("other.txt", kKitti + kKitti);
  const auto tum = folder.write("poses.tum", "0.5 0 0 0 0 0 0 1\n1.5 1 0 0 0 0 0 1\n");
  const auto times = folder.write("times.txt", "5.000000e-01\n1.500000e+00\n");
  const auto [first, second] = read_trajectory_pair(kitti, tum, times);
  EXPECT_EQ(times_of(first.poses), (std::vector<double>{0.5, 1.5}));
  EXPECT_TRUE(first.warnings.empty());
  EXPECT_EQ(second.poses.size(), 2U);

  const auto by_row = read_trajectory_pair(kitti, kitti, std::nullopt);
  EXPECT_THAT(only_warning(by_row.first), HasSubstr("2 poses are paired row by row"));
  EXPECT_EQ(times_of(by_row.first.poses), (std::vector<double>{0, 1}));
  const auto timed = read_trajectory_pair(kitti, kitti, times);
  EXPECT_TRUE(timed.first.warnings.empty());
  EXPECT_EQ(timed.second.poses[1].time_s, 1.5);

  const std::string way_out = "2 poses without times (KITTI's layout); --times FILE gives them";
  EXPECT_THAT(input_error([&] { read_trajectory_pair(kitti, tum, std::nullopt); }), HasSubstr("kitti.txt: " + way_out));
  EXPECT_THAT(input_error([&] { read_trajectory_pair(tum, kitti, std::nullopt); }), HasSubstr("kitti.txt: " + way_out));
  EXPECT_THAT(input_error([&] { read_trajectory_pair(kitti, other, std::nullopt); }), HasSubstr("--times"));
  EXPECT_THAT(input_error([&] { read_trajectory_pair(other, tum, times); }),
              HasSubstr("times.txt: 2 times for the 4 poses of"));
  EXPECT_THAT(input_error([&] { read_trajectory_pair(kitti, tum, tum); }),
              HasSubstr("poses.tum: line 1: 8 numbers; one a line"));
  EXPECT_THROW(read_trajectory_pair(tum, tum, times), UsageError);
}

TEST(TrajectoryFile, TimesThatAreLostOrUnordered) {
  const TempFolder folder;
  const auto kitti = folder.write("kitti.txt", kKitti + kKitti);
  const auto tum = folder.write("poses.tum", "1 0 0 0 0 0 0 1\n");
  const auto [file, ignored] = read_trajectory_pair(kitti, tum, folder.write("times.txt", "3\nnan\n1\n3\n"));
  EXPECT_EQ(times_of(file.poses), (std::vector<double>{1, 3}));
  EXPECT_EQ(file.poses[1].position.x(), 1.0);
  EXPECT_EQ(file.warnings.size(), 3U);  // not finite, unordered, same time
}

TEST(TrajectoryFile, SaysWhatIsWrong) {
  const std::pair<std::string, std::string> kCases[] = {
      {"1 0 0 0 0 0 0 1\n2 0 0 0 0 0 1\n", "line 2: 7 numbers; the poses of this file have 8"},
      {"1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1 9\n", "line 2: 9 numbers"},
      {"1 0 0 0 0 0 0 1 9\n", "line 1: 9 numbers; a pose is read from 8"},
      {"1 0 0 x 0 0 0 1\n", "line 1: 'x' is not a number"},
      {"1 0 0 0\n0 1 0 0\n", "line 1: 4 numbers: a position without orientation"},
      {"1 2 3 0 0 0 1\n", "line 1: 7 numbers: a pose without its time"},
      {"1.5 2 3\n", "line 1: 3 numbers; a pose is read"},
      {"1 0 0 0 0 0 0 0\n", "none of its 1 rows is a pose: 0 not finite, 1 with a quaternion of zero"},
      {"1 nan 0 0 0 0 0 1\n2 nan 0 0 0 0 0 1\n", "none of its 2 rows is a pose: 2 not finite"},
      {"0,5 1,5 0,25 0 0 0 0 1\n", "line 1: mixes ',' and blanks; decimal commas"},
      {"0,5.1;1,5;0,25;0,0;0,0;0,0;0,0;1,0\n", "line 1: mixes ';' and ','; decimal commas"},
      {"time,x,y,z\n1,2,3,4\n", "no columns for x, y, z and w of a quaternion"},
      {"# time x y z q0 q1 q2 q3\n1 2 3 4 1 0 0 0\n", "no columns for x, y, z and w of a quaternion"},
      {"x,y,z,qx,qy,qz,qw\n1,2,3,0,0,0,1\n", "no column for the time"},
      {"time,x,x,z,qx,qy,qz,qw\n1,2,3,4,0,0,0,1\n", "two columns alike: 'x' and 'x'"},
      {"a b c d e f g h\n1 2 3 4 0 0 0 1\n", "the header line 'a b c d e f g h' does not name the 8 columns"},
      {"time,x,y,z,qx,qy,qz,qw\n1,2,3,4,0,0,0\n", "does not name the 7 columns"},
      {"time,x,y,z,qx,qy,qz,qw\n", "no pose follows the header line"},
      {"2011-09-30 12:40:25 1 2 3 0 0 0 1\n", "line 1: 9 numbers"},
      {"1 0 0 1 0 1 0 2 0 0 -1 3\n", "line 1: the matrix deviates by inf"},
      {"1 0 0 1 0 1.01 0 2 0 0 1 3\n", "line 1: the matrix deviates by 0.0201"},
      {"1 0 0 0 0 1 0 0 0 0 1 0 1 2 3 1\n", "line 1: the last row of the matrix is not 0 0 0 1"},
      {"0 0 1\n1 0 0 1\n0 1 0 2\n", "the file ends within a matrix"},
      {"0 0 1\n1 0 0 1\n0 1 0\n", "line 3: 3 numbers; the poses of this file have 4"},
      {"0 1 2\n1 0 0 1\n0 1 0 2\n0 0 1 3\n0 0 0 1\n", "a .log of pairs"},
      {"1 0.9 0.1 0.2 0.3 1.5 2.5 3.5 1 00001.png\n", "is COLMAP's images.txt"},
      {"{\"parameters\": []}", "is JSON"},
      {" [[1, 2]]", "is a list in brackets"},
      {"\x93NUMPY\x01", "is a NumPy array"},
      {"ply\nformat ascii 1.0\n", "is a PLY point cloud"},
      {"VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n", "is a g2o pose graph"},
      {std::string("\xFF\xFE\x31\x00", 4), "is UTF-16 text"},
      {std::string("1 2 \x00 3", 7), "is no text"},
      {"# only a comment\n", "no pose in the file"},
      {"", "the file is empty"},
  };
  for (const auto& [content, message] : kCases) {
    const std::string error = input_error([&] { read_content(content); });
    EXPECT_THAT(error, HasSubstr(message)) << content;
    EXPECT_THAT(error, HasSubstr("poses.tum: "));
  }
  EXPECT_THROW(read_trajectory("/no/such.tum"), InputError);
}

/// pandas writes NaN as an empty field.
TEST(TrajectoryFile, RowsWithEmptyFieldsAreLeftOut) {
  for (const char* text :
       {"1,,,,,,,\n2,1,2,3,0,0,0,1\n3,4,5,6,0,0,0,1\n", "2,1,2,3,0,0,0,1\n2.5,,,,,,,\n3,4,5,6,0,0,0,1\n",
        "1,5,6,7,,,,\n2,1,2,3,0,0,0,1\n3,4,5,6,0,0,0,1\n",
        "t,x,y,z,qx,qy,qz,qw\n1,,,,,,,\n2,1,2,3,0,0,0,1\n3,4,5,6,0,0,0,1\n",
        "1;;;;;;;\n2;1;2;3;0;0;0;1\n3;4;5;6;0;0;0;1\n"}) {
    const TrajectoryFile file = read_content(text);
    ASSERT_EQ(file.poses.size(), 2U) << text;
    EXPECT_EQ(file.poses[1].position, Eigen::Vector3d(4, 5, 6)) << text;
    EXPECT_THAT(only_warning(file), HasSubstr("1 of 3 rows left out: not finite")) << text;
  }
}

TEST(TrajectoryFile, ZeroPosesBetweenOthersAreCounted) {
  const std::string zero = " 0 0 0 0 0 0 1\n", other = " 1 2 3 0 0 0 1\n";
  const TrajectoryFile lost = read_content("1" + other + "2" + zero + "3" + other + "4" + zero + "5" + zero);
  EXPECT_EQ(lost.poses.size(), 5U) << "none is dropped";
  EXPECT_THAT(only_warning(lost), HasSubstr("3 of 5 poses are exactly 0 0 0 without rotation"));
  // A start at rest, one return, the place alone, the rotation alone.
  poses_of("1" + zero + "2" + zero + "3" + other + "4" + zero);
  poses_of("1" + other + "2 0 0 0 0 0 1 0\n3 0 0 0 0 0 1 0\n");
  poses_of("1" + other + "2 0 0 1 0 0 0 1\n3 0 0 1 0 0 0 1\n");
}

bool are_poses(std::string_view content) {
  const TempFolder folder;
  return holds_poses(folder.write("file.txt", content));
}

TEST(HoldsPoses, OfNamesTumAndMatrices) {
  EXPECT_TRUE(are_poses("1 1 2 3 0 0 0.6 0.8\n2 4 5 6 0 0 0.8 0.6\n"));
  EXPECT_TRUE(are_poses("# timestamp tx ty tz qx qy qz qw\n1 1 2 3 0 0 0.6 0.8\n1 4 5 6 0 0 0.8 0.6\n"));
  EXPECT_TRUE(
      are_poses("#timestamp,p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z []\n"
                "1403636580000000000,1,2,3,1,0,0,0\n"));
  EXPECT_TRUE(are_poses("time,x,y,z,qx,qy,qz,qw\n1,1,2,3,0,0,0,1\n"));
  EXPECT_TRUE(are_poses("1 0 0 5 0 1 0 6 0 0 1 7\n0 -1 0 5 1 0 0 6 0 0 1 7\n")) << "KITTI";
}

TEST(HoldsPoses, NotOfPointsWhateverTheirColumns) {
  EXPECT_FALSE(are_poses("0 1 2 3 0 0 1 0\n1 4 5 6 0 1 0 0.01\n")) << "x that rises, a normal and a curvature";
  EXPECT_FALSE(are_poses("0 1 2 255 0 0 1 0\n1 4 5 0 12 9 1 3\n"));
  EXPECT_FALSE(are_poses("x y z r g b a t\n1 2 3 4 5 6 7 8\n"));
  EXPECT_FALSE(are_poses("timestamp,x,y,z,intensity\n1,1,2,3,4\n")) << "a sensor's viewer";
  EXPECT_FALSE(are_poses("1 2 3\n4 5 6\n"));
  EXPECT_FALSE(are_poses("ply\nformat ascii 1.0\nend_header\n"));
  EXPECT_FALSE(are_poses(""));
  EXPECT_FALSE(are_poses("words\n"));
  EXPECT_FALSE(holds_poses("/none/such.tum"));
  EXPECT_FALSE(holds_poses("/tmp")) << "a folder";
}

TEST(TrajectoryFile, TumWrittenAndReadBackIsIdentical) {
  const TempFolder folder;
  const Trajectory t{{1305031102.175304, {0.1, -1.0 / 3, 1e-9}, Eigen::Quaterniond(0.5, -0.5, 0.5, 0.5)},
                     {1305031103.0, {1e6, 2, 3}, Eigen::Quaterniond(0, 0, 0, 1)}};
  write_tum_trajectory(t, folder / "poses.tum");
  const Trajectory copy = read_trajectory(folder / "poses.tum").poses;
  ASSERT_EQ(copy.size(), t.size());
  for (std::size_t i = 0; i < t.size(); ++i) {
    EXPECT_EQ(copy[i].time_s, t[i].time_s);
    EXPECT_EQ(copy[i].position, t[i].position);
    EXPECT_EQ(copy[i].rotation.coeffs(), t[i].rotation.coeffs());
  }
  EXPECT_THROW(write_tum_trajectory(t, folder / "no/such/poses.tum"), OutputError);
}

}  // namespace trajectory_file_test
}  // namespace cmap::testing

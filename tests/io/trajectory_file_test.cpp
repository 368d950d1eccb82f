#include "cmap/io/trajectory_file.hpp"

#include "io/io_testing.hpp"

namespace cmap::testing {
namespace {

using ::testing::HasSubstr;

Trajectory read_content(std::string_view content) {
  const TempFolder folder;
  return read_tum_trajectory(folder.write("poses.tum", content));
}

TEST(TrajectoryFile, ReadsPosesCommentsAndAnyLengthOfQuaternion) {
  const Trajectory t = read_content("# time x y z qx qy qz qw\n\n1.5 1 2 3 0 0 0 1\r\n2.5,4,5,6,0,0,2,2 # turn\n");
  ASSERT_EQ(t.size(), 2u);
  EXPECT_EQ(t[0].time_s, 1.5);
  EXPECT_EQ(t[0].position, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(t[0].rotation.coeffs(), Eigen::Vector4d(0, 0, 0, 1));
  // (0 0 2 2): a quarter turn about z.
  EXPECT_TRUE((t[1].rotation * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY(), 1e-15));
}

TEST(TrajectoryFile, StampsKeepMicroseconds) {
  EXPECT_EQ(read_content("1305031102.175304 0 0 0 0 0 0 1")[0].time_s, 1305031102.175304);
}

TEST(TrajectoryFile, SaysWhatIsWrong) {
  const std::pair<std::string, std::string> kCases[] = {
      {"1 0 0 0 0 0 0 1\n2 0 0 0 0 0 1\n", "line 2: 7 numbers; a pose has 8"},
      {"1 0 0 0 0 0 0 1 9\n", "line 1: more than the 8 numbers"},
      {"1 0 0 x 0 0 0 1\n", "line 1: 'x' is not a number"},
      {"1 0 0 nan 0 0 0 1\n", "line 1: 'nan' is not finite"},
      {"1 0 0 0 0 0 0 0\n", "line 1: the quaternion has length 0"},
      {"2 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n", "line 2: time 1 s is not after the 2 s before it"},
      {"1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n", "line 2: time 1 s is not after"},
      {"# only a comment\n", "no pose in the file"},
      {"", "the file is empty"},
  };
  for (const auto& [content, message] : kCases) {
    try {
      read_content(content);
      ADD_FAILURE() << content;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(message));
      EXPECT_THAT(error.what(), HasSubstr("poses.tum: "));
    }
  }
  EXPECT_THROW(read_tum_trajectory("/no/such.tum"), InputError);
}

TEST(TrajectoryFile, KittiPosesWithTheirTimes) {
  const TempFolder folder;
  const auto poses = folder.write("poses.txt", "1 0 0 1 0 1 0 2 0 0 1 3\n0 -1 0 4 1 0 0 5 0 0 1 6\n");
  const Trajectory t = read_kitti_trajectory(poses, folder.write("times.txt", "0.000000e+00\n1.037359e-01\n"));
  ASSERT_EQ(t.size(), 2u);
  EXPECT_EQ(t[1].time_s, 0.1037359);
  EXPECT_EQ(t[1].position, Eigen::Vector3d(4, 5, 6));
  EXPECT_TRUE((t[1].rotation * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY(), 1e-15));
}

/// VGGT-Long writes the camera's pose, not its inverse.
TEST(TrajectoryFile, CameraPosesByIndexOrTime) {
  const TempFolder folder;
  const auto poses =
      folder.write("camera_poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n0 0 1 7 0 1 0 8 -1 0 0 9 0 0 0 1\n");
  const Trajectory t = read_camera_poses(poses);
  ASSERT_EQ(t.size(), 2u);
  EXPECT_EQ(t[0].time_s, 0.0);
  EXPECT_EQ(t[1].time_s, 1.0);
  EXPECT_EQ(t[1].position, Eigen::Vector3d(7, 8, 9));
  EXPECT_TRUE((t[1].rotation * Eigen::Vector3d::UnitZ()).isApprox(Eigen::Vector3d::UnitX(), 1e-15));
  EXPECT_EQ(read_camera_poses(poses, folder.write("times.txt", "5\n6.5\n"))[1].time_s, 6.5);
}

TEST(TrajectoryFile, BrokenMatricesAndTimes) {
  const std::string kitti = "1 0 0 1 0 1 0 2 0 0 1 3\n", camera = "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n";
  struct Case {
    std::string poses, times, message;
  };
  const auto refusal_of = [](const Case& broken, bool is_camera) -> std::string {
    const TempFolder folder;
    const auto poses = folder.write("poses.txt", broken.poses), times = folder.write("times.txt", broken.times);
    try {
      is_camera ? read_camera_poses(poses, times) : read_kitti_trajectory(poses, times);
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_EQ(refusal_of({kitti, "1\n", ""}, false), "");
  EXPECT_EQ(refusal_of({camera, "1\n", ""}, true), "");
  const Case kKitti[] = {{camera, "1\n", "poses.txt: line 1: more than the 12 numbers"},
                         {"1 0 0 1\n", "1\n", "poses.txt: line 1: 4 numbers; a pose has 12"},
                         {"1 0 0 1 0 1 0 2 0 0 -1 3\n", "1\n", "poses.txt: line 1: the matrix deviates by inf"},
                         {"1 0 0 1 0 1.01 0 2 0 0 1 3\n", "1\n", "poses.txt: line 1: the matrix deviates by 0.0201"},
                         {"1 0 0 nan 0 1 0 2 0 0 1 3\n", "1\n", "poses.txt: line 1: 'nan' is not finite"},
                         {kitti, "1\n2\n", "times.txt: 2 times for 1 poses"},
                         {kitti + kitti, "1\n1\n", "times.txt: line 2: time 1 s is not after"},
                         {kitti, "1 2\n", "times.txt: line 1: more than the 1 numbers"},
                         {"# none\n", "1\n", "poses.txt: no pose in the file"}};
  for (const Case& broken : kKitti) EXPECT_THAT(refusal_of(broken, false), HasSubstr(broken.message));
  const Case kCamera[] = {
      {kitti, "1\n", "line 1: 12 numbers; a pose has 16"},
      {"1 0 0 0 0 1 0 0 0 0 1 0 1 2 3 1\n", "1\n", "line 1: the last row of the matrix is not 0 0 0 1"}};
  for (const Case& broken : kCamera) EXPECT_THAT(refusal_of(broken, true), HasSubstr(broken.message));
}

TEST(TrajectoryFile, TumWrittenAndReadBackIsIdentical) {
  const TempFolder folder;
  const Trajectory t{{1305031102.175304, {0.1, -1.0 / 3, 1e-9}, Eigen::Quaterniond(0.5, -0.5, 0.5, 0.5)},
                     {1305031103.0, {1e6, 2, 3}, Eigen::Quaterniond(0, 0, 0, 1)}};
  write_tum_trajectory(t, folder / "poses.tum");
  const Trajectory copy = read_tum_trajectory(folder / "poses.tum");
  ASSERT_EQ(copy.size(), t.size());
  for (std::size_t i = 0; i < t.size(); ++i) {
    EXPECT_EQ(copy[i].time_s, t[i].time_s);
    EXPECT_EQ(copy[i].position, t[i].position);
    EXPECT_EQ(copy[i].rotation.coeffs(), t[i].rotation.coeffs());
  }
  EXPECT_THROW(write_tum_trajectory(t, folder / "no/such/poses.tum"), UsageError);
}

}  // namespace
}  // namespace cmap::testing

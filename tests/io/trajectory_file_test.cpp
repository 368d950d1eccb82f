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

}  // namespace
}  // namespace cmap::testing

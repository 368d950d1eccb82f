#include "io/io_testing.hpp"

namespace cmap::testing {
namespace nvm_reader_test {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr std::string_view kCameras =
    "2\n"
    "images/a.jpg\t800 1 0 0 0 0 0 0 0 0\n"
    "images/b.jpg\t800 1 0 0 0 -1 0 0 0.01 0\n";

/// As VisualSFM writes it: blank lines between the parts, an empty model and a comment behind the last one.
std::string nvm(std::string_view models) { return "NVM_V3 \n\n" + std::string(models) + "\n0\n\n#the last part\n0\n"; }

std::string warnings_of(const PointCloudFile& file) {
  std::string warnings;
  for (const Warning& warning : file.info.warnings) warnings += warning.id + ": " + warning.message + "\n";
  return warnings;
}

TEST(Nvm, PointsAndColorsOfOneModel) {
  const std::string points = "\n2\n1.5 -2 3 255 0 7 2 0 11 10.5 -20 1 12 3 4\n4 5.25 6 10 20 30 1 1 3 0 0\n";
  for (const char* name : {"a.nvm", "a.txt"}) {
    const auto file = read_content(name, nvm(std::string(kCameras) + points));
    EXPECT_EQ(file.info.format, "NVM");
    ASSERT_EQ(file.info.points, 2U);
    EXPECT_EQ(point(file, 0), Eigen::Vector3d(1.5, -2, 3));
    EXPECT_EQ(point(file, 1), Eigen::Vector3d(4, 5.25, 6));
    EXPECT_EQ(file.cloud.colors, Colors(Array<Rgb8>{{255, 0, 7}, {10, 20, 30}}));
  }
  // COLMAP ends with the points; a fixed calibration stands in the first line.
  const std::string bare = "NVM_V3 FixedK 800 320 800 240 0\r\n\r\n" + std::string(kCameras) + points;
  EXPECT_EQ(read_content("a.nvm", bare).info.points, 2U);
}

TEST(Nvm, TheLargestModelIsUsedAndTheOthersAreSaid) {
  const std::string one = std::string(kCameras) + "1\n9 9 9 1 2 3 0\n";
  const std::string two = std::string(kCameras) + "2\n1 2 3 4 5 6 0\n4 5 6 7 8 9 0\n";
  const std::string none = std::string(kCameras) + "0\n";
  const auto file = read_content("a.nvm", nvm(one + "\n" + two + "\n" + none));
  ASSERT_EQ(file.info.points, 2U);
  EXPECT_EQ(point(file, 0), Eigen::Vector3d(1, 2, 3));
  EXPECT_THAT(warnings_of(file), HasSubstr("parts_unused: the largest of 2 models is used; the others' 1 points"));
}

TEST(Nvm, RefusesWhatIsCutOrDamaged) {
  const std::string cameras(kCameras);
  const auto refused = [](const std::string& models) { return refusal("a.nvm", "NVM_V3\n" + models); };
  EXPECT_THAT(refused(""), HasSubstr("holds no points"));
  EXPECT_THAT(refused(cameras + "0\n"), HasSubstr("holds no points"));
  EXPECT_THAT(refused("3\n" + cameras.substr(2)), HasSubstr("truncated: the file ends where a camera should be"));
  EXPECT_THAT(refused(cameras), HasSubstr("truncated: the file ends where the number of points should be"));
  EXPECT_THAT(refused(cameras + "2\n1 2 3 4 5 6 0\n"), HasSubstr("truncated: the file ends where a point should be"));
  EXPECT_THAT(refused(cameras + "-1\n"), HasSubstr("line 5: '-1' is not the number of points"));
  EXPECT_THAT(refused(cameras + "1\n1 2 3 4 5\n"), HasSubstr("line 6: a point needs x y z r g b"));
  EXPECT_THAT(refused(cameras + "1\n1 2 x 4 5 6 0\n"), AllOf(HasSubstr("line 6"), HasSubstr("'x' is not a number")));
  EXPECT_THAT(refused("two\n"), HasSubstr("line 2: 'two' is not the number of cameras"));
}

}  // namespace nvm_reader_test
}  // namespace cmap::testing

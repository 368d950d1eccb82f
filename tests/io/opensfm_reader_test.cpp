#include "io/io_testing.hpp"

namespace cmap::testing {
namespace opensfm_reader_test {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string reconstruction(std::string_view points) {
  return R"({"cameras": {"c": {"width": 640}}, "shots": {"a.jpg": {}}, "points": {)" + std::string(points) + "}}";
}

const std::string kOpen = "[\n ";

constexpr std::string_view kTwo =
    R"("9": {"color": [255.0, 0.0, 7.0], "coordinates": [1.5, -2, 3e0]},
       "10": {"coordinates": [4.0, 5.25, 6.0], "color": [10, 20, 30]})";

TEST(OpenSfm, PointsWithTheirColors) {
  const auto file = read_content("reconstruction.json", kOpen + reconstruction(kTwo) + "\n]\n");
  EXPECT_EQ(file.info.format, "OpenSfM reconstruction");
  ASSERT_EQ(file.info.points, 2U);
  // In the order of the ids as text.
  EXPECT_EQ(point(file, 0), Eigen::Vector3d(4, 5.25, 6));
  EXPECT_EQ(point(file, 1), Eigen::Vector3d(1.5, -2, 3));
  EXPECT_EQ(file.cloud.colors, Colors(Array<Rgb8>{{10, 20, 30}, {255, 0, 7}}));
}

TEST(OpenSfm, TheLargestOfSeveralAndTheOthersSaid) {
  const std::string one = R"("1": {"color": [1, 2, 250], "coordinates": [7, 8, 9]})";
  const auto file =
      read_content("a.json", kOpen + reconstruction(one) + "," + reconstruction(kTwo) + "," + reconstruction("") + "]");
  EXPECT_EQ(file.info.points, 2U);
  ASSERT_FALSE(file.info.warnings.empty());
  EXPECT_THAT(file.info.warnings[0].message, AllOf(HasSubstr("largest of 3"), HasSubstr("others' 1 points")));
}

TEST(OpenSfm, RefusesWhatIsCutOrMixedUp) {
  const std::string good = kOpen + reconstruction(kTwo) + "]";
  for (std::size_t n = 60; n < good.size(); ++n) {
    EXPECT_THAT(refusal("a.json", good.substr(0, n)), HasSubstr("is no complete JSON")) << n;
  }
  EXPECT_THAT(refusal("a.json", kOpen + reconstruction("") + "]"), HasSubstr("hold no points"));
  EXPECT_THAT(refusal("a.json", kOpen + reconstruction(R"("1": {"color": [1, 2, 3]})") + "]"),
              HasSubstr("point '1': 'coordinates' is not three numbers"));
  EXPECT_THAT(refusal("a.json", kOpen + reconstruction(R"("1": {"color": [1, 2], "coordinates": [1, 2, 3]})") + "]"),
              HasSubstr("'color' is not three numbers"));
  EXPECT_THAT(refusal("a.json", kOpen + reconstruction(R"("1": 5)") + "]"), HasSubstr("is not three numbers"));
  EXPECT_THAT(refusal("a.json", "[1, \"cameras\", \"shots\"]"), HasSubstr("hold no points"));
}

}  // namespace opensfm_reader_test
}  // namespace cmap::testing

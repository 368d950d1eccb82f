// What of a LAS file is no point of the map.

#include <limits>

#include "io/las_testing.hpp"

namespace cmap::testing {
namespace las_selection_test {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::int32_t kLowest = std::numeric_limits<std::int32_t>::min();
constexpr std::int32_t kHighest = std::numeric_limits<std::int32_t>::max();

/// Points in a row along x at 0, 1, 2 ... m.
Las row(U8 format, std::size_t n) {
  Las las{.minor = 4, .format = format, .offset = {0, 0, 0}, .points = {}};
  for (std::size_t i = 0; i < n; ++i) las.points.push_back({static_cast<std::int32_t>(100 * i), 0, 0});
  return las;
}

/// Where along x the points are that were kept.
std::vector<int> kept(const PointCloudFile& file) {
  std::vector<int> places;
  for (std::size_t i = 0; i < file.cloud.size(); ++i) {
    places.push_back(static_cast<int>(std::lround(point(file, i).x())));
  }
  return places;
}

std::string left_out(const PointCloudFile& file) {
  std::string text;
  for (const LeftOut& points : file.info.left_out) text += std::to_string(points.n) + " " + points.reason + "; ";
  return text;
}

class EveryFormat : public ::testing::TestWithParam<int> {
 protected:
  U8 format() const { return static_cast<U8>(GetParam()); }
};

TEST_P(EveryFormat, WithheldAndNoiseAreLeftOutAndCounted) {
  Las las = row(format(), 7);
  las.classes = {2, 7, 18, 12, 7, 2, 0};
  las.withheld = {0, 0, 0, 0, 1, 1, 0};
  const auto file = read_content("a.las", las.file().str());
  EXPECT_THAT(kept(file), ElementsAre(0, 3, 6)) << "overlap, synthetic and key points stay";
  EXPECT_EQ(left_out(file), "2 withheld; 1 noise class 7; 1 noise class 18; ");
  EXPECT_EQ(file.info.points, 7U);
  EXPECT_EQ(file.info.finite_points, 3U);
}

TEST_P(EveryFormat, NoiseStaysWhereAskedForButNotTheWithheld) {
  Las las = row(format(), 4);
  las.classes = {2, 7, 18, 7};
  las.withheld = {0, 0, 0, 1};
  EXPECT_THAT(kept(read_content("a.las", las.file().str(), {.keep_noise = true})), ElementsAre(0, 1, 2));
}

TEST_P(EveryFormat, ClassesAskedFor) {
  Las las = row(format(), 6);
  las.classes = {2, 6, 7, 5, 2, 31};
  auto file = read_content("a.las", las.file().str(), {.classes = {2, 6}});
  EXPECT_THAT(kept(file), ElementsAre(0, 1, 4));
  EXPECT_EQ(left_out(file), "3 not of class 2, 6; ");
  file = read_content("a.las", las.file().str(), {.classes = {7, 31}});
  EXPECT_THAT(kept(file), ElementsAre(2, 5)) << "noise that is asked for by its class";
}

INSTANTIATE_TEST_SUITE_P(Las, EveryFormat, ::testing::Range(0, 11));

TEST(LasSelection, EightBitsOfClassInNewFormats) {
  Las las = row(6, 3);
  las.classes = {39, 34, 50};  // 7, 2 and 18 in their lower five bits
  EXPECT_THAT(kept(read_content("a.las", las.file().str())), ElementsAre(0, 1, 2));
  EXPECT_THAT(kept(read_content("a.las", las.file().str(), {.classes = {34}})), ElementsAre(1));
}

TEST(LasSelection, FarIntoTheFileAndAcrossBlocks) {
  Las las = row(3, 70000);
  las.points.resize(70000);
  las.classes.assign(70000, 2);
  las.withheld.assign(70000, 0);
  for (std::size_t i = 0; i < 70000; ++i) {
    if (i % 1000 == 999) las.classes[i] = 7;
    if (i >= 40000 && i < 45000) las.withheld[i] = 1;
    las.colors.resize(1);
  }
  const auto file = read_content("a.las", las.file().str());
  EXPECT_EQ(left_out(file), "65 noise class 7; 5000 withheld; ");
  std::vector<int> expected;
  for (int i = 0; i < 70000; ++i) {
    if (i % 1000 != 999 && (i < 40000 || i >= 45000)) expected.push_back(i);
  }
  EXPECT_EQ(kept(file), expected);
}

TEST(LasSelection, NothingLeftOutIsNotSaid) {
  const auto file = read_content("a.las", row(7, 3).file().str());
  EXPECT_TRUE(file.info.left_out.empty());
  EXPECT_TRUE(file.info.warnings.empty());
}

TEST(LasSelection, ClassesThatTheFileDoesNotHave) {
  Las las = row(3, 3);
  las.classes = {1, 5, 5};
  try {
    read_content("a.las", las.file().str(), {.classes = {2}});
    FAIL();
  } catch (const UnsupportedError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("a.las: no point of class 2"), HasSubstr("of class 1, 5")));
  }
}

TEST(LasSelection, ClassesOfAFileWithoutThem) {
  try {
    read_content("a.xyz", "1 2 3\n4 5 6\n", {.classes = {2}});
    FAIL();
  } catch (const UnsupportedError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("a.xyz: "), HasSubstr("only LAS files")));
  }
}

TEST(LasSelection, AllWithheldIsNoMap) {
  Las las = row(3, 2);
  las.withheld = {1, 1};
  EXPECT_THAT(refusal("a.las", las.file().str()), HasSubstr("2 left out: withheld"));
}

TEST(LasSelection, ThreeLowestIntegersAreNoNumber) {
  Las las = row(3, 5);
  las.points[1] = {kLowest, kLowest, kLowest};
  const auto file = read_content("a.las", las.file().str());
  EXPECT_THAT(kept(file), ElementsAre(0, 2, 3, 4));
  EXPECT_THAT(left_out(file), HasSubstr("1 not a number"));
  las.points.assign(3, {kLowest, kLowest, kLowest});
  EXPECT_THAT(refusal("a.las", las.file().str()), HasSubstr("the offsets were lost on writing"));
}

TEST(LasSelection, AnAxisAtTheEndOfItsIntegersIsNamed) {
  for (const std::int32_t end : {kLowest, kHighest}) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Las las = row(3, 5);
      for (std::size_t i = 0; i < 5; ++i) las.points[i] = {7, 8, static_cast<std::int32_t>(i)};
      for (auto& p : las.points) p[axis] = end;
      EXPECT_THAT(refusal("a.las", las.file().str()),
                  AllOf(HasSubstr(std::string(1, "xyz"[axis]) + " stands at " + std::to_string(end)),
                        HasSubstr("its offset was lost")));
    }
  }
}

TEST(LasSelection, SomeOfAnAxisAtTheEndIsAWarning) {
  Las las = row(3, 300);
  las.points[299][2] = kHighest;
  EXPECT_THAT(all_warnings(read_content("a.las", las.file().str())), Not(HasSubstr("cut_off_coordinates")))
      << "an axis may be scaled to just fit";
  for (std::size_t i = 0; i < 30; ++i) las.points[i][1] = kLowest;
  EXPECT_THAT(all_warnings(read_content("a.las", las.file().str())),
              AllOf(HasSubstr("cut_off_coordinates: 30 of 300 points stand at the end of the integers of y"),
                    Not(HasSubstr("of z"))));
}

}  // namespace las_selection_test
}  // namespace cmap::testing

#include "io/io_testing.hpp"

namespace cmap::testing {
namespace obj_reader_test {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(ObjPoints, VerticesOnlyAreACloud) {
  for (const char* name : {"a.obj", "a.txt"}) {
    const auto file = read_content(name, "# by hand\no cloud\nv 1 2 3\nvn 0 0 1\nv  -4 5.5 6 \r\n\np 1 2\n");
    EXPECT_EQ(file.info.format, "OBJ points");
    ASSERT_EQ(file.info.points, 2U);
    EXPECT_EQ(point(file, 0), Eigen::Vector3d(1, 2, 3));
    EXPECT_EQ(point(file, 1), Eigen::Vector3d(-4, 5.5, 6));
    EXPECT_FALSE(file.cloud.has_color());
  }
}

TEST(ObjPoints, ColorsFollowThePosition) {
  const auto file = read_content("a.obj", "v 1 2 3 1 0 0.25\nv 4 5 6 0 0.5 1\n");
  EXPECT_EQ(file.cloud.colors, Colors(Array<RgbF>{{1.0F, 0.0F, 0.25F}, {0.0F, 0.5F, 1.0F}}));
  const auto whole = read_content("a.obj", "v 1 2 3 255 0 7\nv 4 5 6 10 20 30\n");
  EXPECT_EQ(whole.cloud.colors, Colors(Array<Rgb8>{{255, 0, 7}, {10, 20, 30}}));
}

TEST(ObjPoints, TheWeightIsNotUsedAndSaid) {
  const auto file = read_content("a.obj", "v 1 2 3 1.0 0.5 0.25 0\n");
  EXPECT_EQ(file.cloud.colors, Colors(Array<RgbF>{{0.5F, 0.25F, 0.0F}}));
  EXPECT_THAT(all_notes(file), HasSubstr("weight"));
  EXPECT_THAT(all_notes(read_content("a.obj", "v 1 2 3 1.0\n")), HasSubstr("weight"));
}

TEST(ObjPoints, AMeshIsNamed) {
  EXPECT_THAT(refusal("a.obj", "v 1 2 3\nv 4 5 6\nv 7 8 10\nf 1 2 3\n"),
              AllOf(HasSubstr("is a mesh (OBJ; line 4"), HasSubstr("sample points on its surface")));
  EXPECT_THAT(refusal("a.obj", "f 1//1 2//2 3//3\nv 1 2 3\n"), HasSubstr("is a mesh"));
}

TEST(ObjPoints, RefusesWhatIsCutOrMixedUp) {
  EXPECT_THAT(refusal("a.obj", "v 1 2 3\nv 4 5\n"), HasSubstr("line 2: a vertex of 2 numbers"));
  EXPECT_THAT(refusal("a.obj", "v 1 2 3 1 0 0\nv 4 5 6\n"), HasSubstr("line 2: a vertex of 3 numbers where the first"));
  EXPECT_THAT(refusal("a.obj", "v 1 2 3 4 5\n"), HasSubstr("a vertex of 5 numbers"));
  EXPECT_THAT(refusal("a.obj", "v 1 2 3 4 5 6 7 8\n"), HasSubstr("more than 7"));
  EXPECT_THAT(refusal("a.obj", "v 1 2 three\n"), HasSubstr("line 1: 'three' is not a number"));
  EXPECT_THAT(refusal("a.obj", "# nothing\n"), HasSubstr("without a vertex"));
}

}  // namespace obj_reader_test
}  // namespace cmap::testing

#include "cmap/io/shift_hint.hpp"

#include "io/io_testing.hpp"

namespace cmap {
namespace shift_hint_test {

using cmap::testing::TempFolder;
using ::testing::HasSubstr;
using ::testing::SizeIs;

const Eigen::Vector3d kShift{651000.5, 6861000, 35.25};

TEST(ShiftHint, OfACommentInAPly) {
  const TempFolder folder;
  const auto hints = find_shift_hints(
      folder.write("map.ply",
                   "ply\nformat ascii 1.0\ncomment made by us\ncomment IGN offset Pos 651000.5 6861000 35.25\n"
                   "element vertex 1\nproperty float x\nend_header\ncomment offset 1 2 3\n"));
  ASSERT_THAT(hints, SizeIs(1));
  EXPECT_EQ(hints[0].shift_m, kShift);
  EXPECT_EQ(hints[0].where, "the comment 'IGN offset Pos 651000.5 6861000 35.25' of map.ply");
}

TEST(ShiftHint, OfOtherComments) {
  for (const char* text :
       {"# Offset: 651000.5, 6861000, 35.25\r\n1 2 3\r\n", "//Global shift (651000.5; 6861000; 35.25)\n1 2 3\n",
        "ply\nobj_info shift=651000.5 6861000 35.25\nend_header\n",
        "# .PCD v0.7\n# offset 651000.5 6861000 35.25\nVERSION 0.7\nDATA ascii\n1 2 3\n"}) {
    const TempFolder folder;
    const auto hints = find_shift_hints(folder.write("map.txt", text));
    ASSERT_THAT(hints, SizeIs(1)) << text;
    EXPECT_EQ(hints[0].shift_m, kShift) << text;
  }
}

TEST(ShiftHint, IsNoneOfOtherLines) {
  for (const char* text :
       {"", "# offset\n", "# offset 1 2\n", "# offset 1 2 3 4\n", "# offset nan inf 3\n", "offset 1 2 3\n",
        "ply\ncomment Generated 1 2 3\nend_header\n", "DATA ascii\n# offset 1 2 3\n"}) {
    const TempFolder folder;
    EXPECT_THAT(find_shift_hints(folder.write("map.txt", text)), SizeIs(0)) << text;
  }
}

TEST(ShiftHint, OfPix4dsProject) {
  const TempFolder folder;
  folder.write("quarry_offset.xyz", "651000.5 6861000 35.25\n");
  folder.write("other_offset.xyz", "1 2 3\n");
  const auto hints = find_shift_hints(folder.write("quarry_densified_point_cloud.ply", "ply\n"));
  ASSERT_THAT(hints, SizeIs(1));
  EXPECT_EQ(hints[0].shift_m, kShift);
  EXPECT_EQ(hints[0].where, "quarry_offset.xyz");
}

TEST(ShiftHint, OfOpenDroneMap) {
  for (const char* name : {"coords.txt", "odm_georeferencing_model_geo.txt"}) {
    const TempFolder folder;
    folder.write(name, "WGS84 UTM 31N\r\n651000.5 6861000\r\n12.5 8.25 110.5\r\n");
    const auto hints = find_shift_hints(folder.write("map.ply", "ply\n"));
    ASSERT_THAT(hints, SizeIs(1)) << name;
    EXPECT_EQ(hints[0].shift_m, Eigen::Vector3d(651000.5, 6861000, 0)) << "heights are absolute";
  }
  const TempFolder folder;
  folder.write("coords.txt", "651000.5 6861000\n1 2 3\n");
  EXPECT_THAT(find_shift_hints(folder.write("map.ply", "ply\n")), SizeIs(0));
}

TEST(ShiftHint, OfOpenSfmTwoFoldersAbove) {
  const TempFolder folder;
  std::filesystem::create_directories(folder / "undistorted/depthmaps");
  folder.write("reference_lla.json", R"({"latitude": 45.0, "longitude": 9.0, "altitude": 120.5})");
  const auto hints = find_shift_hints(folder.write("undistorted/depthmaps/merged.ply", "ply\n"));
  ASSERT_THAT(hints, SizeIs(1));
  EXPECT_NEAR(hints[0].shift_m.x(), 500000, 1e-3);
  EXPECT_NEAR(hints[0].shift_m.y(), 4982950.400, 1e-3);
  EXPECT_EQ(hints[0].shift_m.z(), 120.5);
  EXPECT_TRUE(hints[0].is_approximate);
  for (const char* broken :
       {"", "[1, 2]", "{\"latitude\": 45.0}", R"({"latitude": 95, "longitude": 9, "altitude": 1})"}) {
    folder.write("reference_lla.json", broken);
    EXPECT_THAT(find_shift_hints(folder / "undistorted/depthmaps/merged.ply"), SizeIs(0)) << broken;
  }
}

TEST(ShiftHint, IsNoneOfWhatIsNoFile) {
  const TempFolder folder;
  EXPECT_THAT(find_shift_hints(folder.path()), SizeIs(0));
  EXPECT_THAT(find_shift_hints(folder / "missing.ply"), SizeIs(0));
  EXPECT_THAT(find_shift_hints("/dev/null"), SizeIs(0));
}

TEST(Utm, IsThatOfOtherFormulas) {
  // Redfearn's series with the meridian's arc integrated numerically.
  struct Place {
    double latitude_deg, longitude_deg, east_m, north_m;
  };
  for (const Place& p : {Place{45, 9, 500000.0, 4982950.4002},
                         {48.8583, 2.2945, 448251.8983, 5411943.7938},
                         {-33.8568, 151.2153, 334900.5697, 6252288.7529},
                         {52.52, 13.405, 391779.2593, 5820072.1592}}) {
    const Eigen::Vector2d utm = utm_of(p.latitude_deg, p.longitude_deg);
    EXPECT_NEAR(utm.x(), p.east_m, 1e-3);
    EXPECT_NEAR(utm.y(), p.north_m, 1e-3);
  }
}

}  // namespace shift_hint_test
}  // namespace cmap

#include <fmt/format.h>

#include "io/io_testing.hpp"

namespace cmap::testing {
namespace text_reader_test {

using ::testing::HasSubstr;

TEST(TextReader, EverySeparator) {
  for (const char* text : {"1 2 3\n4 5 6\n", "1,2,3\n4,5,6\n", "1;2;3\n4;5;6\n", "1\t2\t3\n4\t5\t6",
                           "1, 2 ,3\r\n4 , 5,6\r\n", " 1,  2, 3,\n\n4,5,6 ,\n", "1 2 3\r4 5 6\r", "1 2 3\r\r4 5 6",
                           "\xef\xbb\xbf"
                           "1 2 3\n4 5 6\n"}) {
    const auto file = read_content("a.xyz", text);
    EXPECT_EQ(file.info.format, "text");
    ASSERT_EQ(file.info.points, 2U) << text;
    EXPECT_EQ(point(file, 0), Eigen::Vector3d(1, 2, 3)) << text;
    EXPECT_EQ(point(file, 1), Eigen::Vector3d(4, 5, 6)) << text;
    EXPECT_FALSE(file.cloud.has_color());
  }
}

TEST(TextReader, LineEndsMayBeMixed) {
  for (const char* text :
       {"# made by me\r\n1 2 3\r4 5 6\r", "# made by me\n1 2 3\r4 5 6", "# made by me\r1 2 3\n4 5 6\n",
        "# made by me\r1 2 3\r\n4 5 6\r\n", "1 2 3\r\r\n4 5 6\r\r\n"}) {
    const auto file = read_content("a.xyz", text);
    ASSERT_EQ(file.info.points, 2U) << text;
    EXPECT_EQ(point(file, 1), Eigen::Vector3d(4, 5, 6)) << text;
  }
}

TEST(TextReader, ColorsAboveOneAreEightBit) {
  const auto file = read_content("a.txt", "# x y z\n1 2 3 0 1 1\n4 5 6 255 128 0\n");
  EXPECT_EQ(file.cloud.colors, Colors(Array<Rgb8>{{0, 1, 1}, {255, 128, 0}}));
  EXPECT_THAT(all_notes(file), HasSubstr("0 to 255"));
}

TEST(TextReader, ColorsUpToOneAreUnitColors) {
  const auto file = read_content("a.txt", "1 2 3 0 0.5 1\n4 5 6 1 1 1\n");
  EXPECT_EQ(file.cloud.colors, Colors(Array<RgbF>{{0.0F, 0.5F, 1.0F}, {1.0F, 1.0F, 1.0F}}));
  EXPECT_THAT(all_notes(file), HasSubstr("[0,1]"));
}

TEST(TextReader, HeaderLineNamesColumns) {
  for (const char* text :
       {"R,G,B,label,z,y,x\n10,20,30,9,3,2,1\n", "\"red\";\"green\";\"blue\";n;\"Z\";\"Y\";\"X\"\n10;20;30;9;3;2;1\n",
        "//R G B I Z Y X\n10 20 30 9 3 2 1\n", "# comment\n# r g b i z y x\n10 20 30 9 3 2 1\n"}) {
    const auto file = read_content("a.csv", text);
    EXPECT_EQ(point(file, 0), Eigen::Vector3d(1, 2, 3)) << text;
    EXPECT_EQ(file.cloud.colors, Colors(Array<Rgb8>{{10, 20, 30}})) << text;
  }
}

TEST(TextReader, HeaderWithNormalsTakesNoColor) {
  const auto file = read_content("a.csv", "x,y,z,nx,ny,nz\n1,2,3,0,0,-1\n");
  EXPECT_FALSE(file.cloud.has_color());
}

TEST(TextReader, UnnamedColumnsAreNoted) {
  EXPECT_THAT(all_notes(read_content("a.xyz", "1 2 3 0.5\n")), HasSubstr("column 4 ignored"));
  EXPECT_THAT(all_notes(read_content("a.xyz", "1 2 3 0 9 -8 -7\n")), HasSubstr("columns 4 to 7 ignored"));
}

TEST(TextReader, HeadersInUse) {
  // What CloudCompare, survey programs, a LiDAR viewer and pandas write above one and the same point.
  for (const char* text :
       {"//X Y Z R G B\n1\n1 2 3 10 20 30\n", "# ID EASTING NORTHING HEIGHT R G B\n7 1 2 3 10 20 30\n",
        "Easting\tNorthing\tHeight\tRed\tGreen\tBlue\n1\t2\t3\t10\t20\t30\n",
        "Slot ID,Error Code,X,Y,Z,Red,Green,Blue\n1,0,1,2,3,10,20,30\n", ",x,y,z,red,green,blue\n0,1,2,3,10,20,30\n",
        "X [m];Y [m];Z [m];Intensity;R;G;B\n1;2;3;;10;20;30\n", "X,Y,Z,Classification,R,G,B\n1,2,3,tree,10,20,30\n",
        "Class Name,Pos X,Pos Y,Pos Z,Red,Green,Blue\ntree,1,2,3,10,20,30\n"}) {
    const auto file = read_content("a.csv", text);
    EXPECT_EQ(point(file, 0), Eigen::Vector3d(1, 2, 3)) << text;
    EXPECT_EQ(file.cloud.colors, Colors(Array<Rgb8>{{10, 20, 30}})) << text;
  }
  const auto unit = read_content("a.txt", "//X Y Z Rf Gf Bf\n1 2 3 0.5 1 0\n");
  EXPECT_EQ(unit.cloud.colors, Colors(Array<RgbF>{{0.5F, 1.0F, 0.0F}}));
}

TEST(TextReader, RowNamesWithoutANameOfTheirOwn) {
  // R's write.table() names the rows, but not the column of their names.
  const auto file = read_content("a.txt", "\"x\" \"y\" \"z\"\n\"1\" 7 8 9\n\"2\" 4 5 6\n");
  ASSERT_EQ(file.cloud.size(), 2U);
  EXPECT_EQ(point(file, 1), Eigen::Vector3d(4, 5, 6));
  EXPECT_THAT(refusal("a.txt", "x y z\n1 7 8 9\n5 4 5 6\n"), HasSubstr("4 columns, but the header line names 3"));
  EXPECT_THAT(refusal("a.txt", "x y z\n1 7 8 9\n"), HasSubstr("4 columns, but the header line names 3"));
}

TEST(TextReader, ColumnsNotUsedAreSaid) {
  EXPECT_THAT(all_notes(read_content("a.csv", "x,y,z,intensity,time\n1,2,3,4,5\n")),
              HasSubstr("not used: intensity, time"));
}

TEST(TextReader, DecimalCommas) {
  for (const char* text : {"1,5\t2\t-3,25\n4\t5\t6\n", "1,5;2;-3,25\n4;5;6\n", "1,5 2,0 -3,25\n4 5 6\n"}) {
    const auto file = read_content("a.txt", text);
    ASSERT_EQ(file.cloud.size(), 2U) << text;
    EXPECT_EQ(point(file, 0), Eigen::Vector3d(1.5, 2, -3.25)) << text;
    EXPECT_THAT(all_notes(file), HasSubstr("decimal"));
  }
}

TEST(TextReader, QuotedNumbers) {
  for (const char* text : {"\"1,5\",\"2,5\",\"-3,25\"\n\"4\",\"5,0\",6\n", "x,y,z\n\"1,5\",\"2,5\",\"-3,25\"\n4,5,6\n",
                           "\"x\",\"y\",\"z\"\n\"1,5\" , \"2,5\" , \"-3,25\"\n4,5,6\n", "'1,5','2,5','-3,25'\n4,5,6\n",
                           "\"1.5\",\"2.5\",\"-3.25\"\n\"4\",\"5\",\"6\"\n", "\"1.5\" \"2.5\" \"-3.25\"\n4 5 6\n",
                           "\"1,5\";\"2,5\";\"-3,25\"\n4;5;6\n"}) {
    const auto file = read_content("a.csv", text);
    ASSERT_EQ(file.cloud.size(), 2U) << text;
    EXPECT_EQ(point(file, 0), Eigen::Vector3d(1.5, 2.5, -3.25)) << text;
    EXPECT_EQ(point(file, 1), Eigen::Vector3d(4, 5, 6)) << text;
  }
  EXPECT_THAT(refusal("a.csv", "\"1,5\",2.5,3\n"), HasSubstr("line 1: commas between quotes beside decimal points"));
  const auto named = read_content("a.csv", "\"label, free\",x,y,z\n\"a, b\",1,2,3\n");
  EXPECT_EQ(point(named, 0), Eigen::Vector3d(1, 2, 3)) << "commas between quotes are of the name";
}

/// 1,5, 2,5, 3,5: three numbers or six columns.
TEST(TextReader, DecimalCommasBetweenCommasAreRefused) {
  for (const char* text : {"1,5, 2,5, 3,5\n4,5, 5,5, 6,5\n", "1,5 ,2,5 ,3,5\n", "0,5, 2, 3,25, 255, 0, 12\n"}) {
    EXPECT_THAT(refusal("a.csv", text),
                HasSubstr("line 1: some commas have blanks beside them and others not; decimal"))
        << text;
  }
  for (const char* text : {"1,5,2,05,3,5\n4,5,5,5,6,5\n", "-1,5,2,5,3,5\n4,00,-5,5,6,5\n"}) {
    EXPECT_THAT(refusal("a.csv", text), HasSubstr("line 1: commas between whole numbers, of which some begin with 0"))
        << text;
  }
  EXPECT_EQ(refusal("a.csv", "01,05,02,05,03,05\n"), "") << "numbers of two digits";
  // No decimal commas: points, two commas in a piece, or fewer than three pieces.
  for (const char* text : {"1.5,2, 3\n", "1,2,3, 10,20,30\n", "1,2, 3\n", "1,2,3,10, 20, 30\n"}) {
    EXPECT_EQ(refusal("a.csv", text), "") << text;
  }
}

/// pandas writes NaN as an empty cell.
TEST(TextReader, PointsWithoutColorHaveEmptyCells) {
  for (const char* rows : {"1,2,3,10,20,255\n4,5,6,,,\n7,8,9,,255,6\n", "4,5,6,,,\n7,8,9,10,,\n1,2,3,10,20,255\n"}) {
    const auto file = read_content("a.csv", "x,y,z,r,g,b\n" + std::string(rows));
    ASSERT_EQ(file.cloud.size(), 3U);
    ASSERT_EQ(file.info.warnings.size(), 1U);
    EXPECT_THAT(file.info.warnings[0].message, HasSubstr("2 of 3 points have no color"));
  }
}

/// `rest` of point i of 12 behind its row's number, from `first` on.
template <class Rest>
std::string numbered(int first, Rest&& rest) {
  std::string text;
  for (int i = 0; i < 12; ++i) text += fmt::format("{} {}\n", first + i, rest(i));
  return text;
}

TEST(TextReader, NumbersOfRowsAreNoX) {
  const auto xyz = [](int i) { return fmt::format("{} {} {}", 0.5 + i, 2.25 - i * i, 0.125 * i); };
  const auto color = [](int i) { return fmt::format(" {} {} {}", 20 * i, 255 - i, i * i); };
  const std::string cases[] = {
      numbered(0, xyz), numbered(1, [&](int i) { return xyz(i) + color(i); }),
      numbered(0, [&](int i) { return xyz(i) + color(i) + fmt::format(" {}", 0.25 + 0.01 * i); })};
  for (const std::string& text : cases) {
    const auto file = read_content("a.txt", text);
    EXPECT_EQ(point(file, 3), Eigen::Vector3d(3.5, -6.75, 0.375)) << text;
    EXPECT_THAT(all_notes(file), HasSubstr("column 1 numbers the rows"));
    EXPECT_EQ(file.cloud.has_color(), &text != cases) << text;
    if (!file.cloud.has_color()) continue;
    EXPECT_EQ(std::get<Array<Rgb8>>(file.cloud.colors)[3], (Rgb8{60, 252, 9}));
    EXPECT_THAT(all_notes(file), HasSubstr("columns 5 to 7 taken as red, green and blue"));
  }
  // Whole numbers throughout: cells of a grid with their numbers, or points one unit apart in x.
  EXPECT_THAT(refusal("a.txt", numbered(1, [&](int i) { return fmt::format("{} {} 7", i % 4, i % 3); })),
              HasSubstr("column 1 counts from 1 on: numbers of the rows, or an x"));
  // A line of a raster, an x with colors, numbers from elsewhere on, few rows.
  const auto x_of = [](const std::string& text) { return point(read_content("a.txt", text), 3).x(); };
  EXPECT_EQ(x_of(numbered(0, [](int i) { return fmt::format("5.5 {} 17", 0.25 * i); })), 3.0);
  EXPECT_EQ(x_of(numbered(0, [&](int i) { return fmt::format("{} {}", 0.5 * i, 0.25 * i) + color(i); })), 3.0);
  EXPECT_EQ(x_of(numbered(7, xyz)), 10.0);
  EXPECT_EQ(x_of("0 .5 .5 .5\n1 1.5 2.5 3.5\n2 1.5 2.5 4.5\n3 1.5 2.5 5.5\n"), 3.0);
}

TEST(TextReader, NamesInCommentsOfAnyKind) {
  for (const char* text :
       {"# columns: id, z, y, x, r, g, b\n9 3 2 1 10 20 30\n", "# point id, z, y, x, r, g, b\n9 3 2 1 10 20 30\n",
        "# id z y x r g b (meters)\n9 3 2 1 10 20 30\n",
        "# [0] id [1] z [2] y [3] x [4] r [5] g [6] b\n9 3 2 1 10 20 30\n",
        "# 0: id, 1: z, 2: y, 3: x, 4: r, 5: g, 6: b\n9 3 2 1 10 20 30\n", "# format: z y x r g b\n3 2 1 10 20 30\n",
        "% z y x r g b\n3 2 1 10 20 30\n", "%z y x r g b\n3 2 1 10 20 30\n", "; z y x r g b\n3 2 1 10 20 30\n",
        "! z y x r g b\n3 2 1 10 20 30\n", "% from MATLAB\n% z y x r g b\n3 2 1 10 20 30\n",
        ";z;y;x;r;g;b\n0;3;2;1;10;20;30\n", "# z | y | x | r | g | b\n3 2 1 10 20 30\n",
        "Fields: z y x r g b\n3 2 1 10 20 30\n"}) {
    const auto file = read_content("a.txt", text);
    ASSERT_EQ(file.cloud.size(), 1U) << text;
    EXPECT_EQ(point(file, 0), Eigen::Vector3d(1, 2, 3)) << text;
    EXPECT_EQ(file.cloud.colors, Colors(Array<Rgb8>{{10, 20, 30}})) << text;
  }
  const auto prose = read_content("a.txt", "# my note: none of z y x r\n3 2 1 10 20 30\n");
  EXPECT_EQ(point(prose, 0), Eigen::Vector3d(3, 2, 1)) << "a sentence names nothing";
  const auto feet = read_content("a.txt", "# x [ft] y [ft] z [ft] i\n1 2 3 4\n");
  ASSERT_EQ(feet.info.warnings.size(), 1U);
  EXPECT_EQ(feet.info.warnings[0].id, "unit_in_name");
}

TEST(TextReader, NamesWithBlanksBetweenTabs) {
  for (const char* text : {"Coord X [m]\tCoord Y [m]\tCoord Z [m]\tColor R\tColor G\tColor B\n1\t2\t3\t10\t20\t30\n",
                           "# Pos X\tPos Y\tPos Z\tRed\tGreen\tBlue\n1\t2\t3\t10\t20\t30\n",
                           "X\tY\tZ\tscan label\tR\tG\tB\n1\t2\t3\tfirst floor\t10\t20\t30\n"}) {
    const auto file = read_content("a.txt", text);
    EXPECT_EQ(point(file, 0), Eigen::Vector3d(1, 2, 3)) << text;
    EXPECT_EQ(file.cloud.colors, Colors(Array<Rgb8>{{10, 20, 30}})) << text;
  }
}

TEST(TextReader, CountLines) {
  for (const char* name : {"a.pts", "a.txt", "a.xyz"}) {
    const auto file = read_content(name, "2\n1 2 3 -1200 10 20 30\n4 5 6 -900 40 50 60\n");
    ASSERT_EQ(file.cloud.size(), 2U);
    EXPECT_EQ(point(file, 1), Eigen::Vector3d(4, 5, 6));
    EXPECT_EQ(file.cloud.colors, Colors(Array<Rgb8>{{10, 20, 30}, {40, 50, 60}}));
  }
  const auto blocks = read_content("a.pts", "2\n1 2 3\n4 5 6\n1\n7 8 9\n");
  EXPECT_EQ(blocks.cloud.size(), 3U);
  EXPECT_THAT(all_notes(read_content("a.pts", "1\n1 2 3\n4 5 6\n")), HasSubstr("announces 1 points, but 1 more"));
}

TEST(TextReader, CoordinatesAreDouble) {
  const auto file = read_content("a.xyz", "500000.1234 4000000.4321 0.5\n500001.1234 4000001.4321 1.5\n");
  EXPECT_LT((point(file, 0) - Eigen::Vector3d(500000.1234, 4000000.4321, 0.5)).norm(), 1e-6);
}

TEST(TextReader, NonFinitePointsAreDroppedAndCounted) {
  const auto file = read_content("a.xyz", "nan 2 3 1 2 3\n1 inf 3 1 2 3\n1 2 3 4 5 6\n");
  EXPECT_EQ(file.info.points, 3U);
  ASSERT_EQ(file.info.finite_points, 1U);
  EXPECT_EQ(file.cloud.colors, Colors(Array<Rgb8>{{4, 5, 6}}));
}

TEST(TextReader, WhatNoSensorMeasuredIsLeftOutAndCounted) {
  std::string text = "1e9 2 3\n1 2 3.4028235e38\n-2 -3 -1000000001\n";
  for (int i = 0; i < 40; ++i) text += fmt::format("{} 2 3\n0 0 0\n", i + 600000);
  const auto file = read_content("a.xyz", text);
  EXPECT_EQ(file.info.points, 83U);
  ASSERT_EQ(file.cloud.size(), 40U);
  EXPECT_EQ(point(file, 39), Eigen::Vector3d(600039, 2, 3));
  EXPECT_GT(file.cloud.origin.x(), 5e5) << "points at 0 0 0 do not choose the origin";
  EXPECT_THAT(all_notes(file),
              ::testing::AllOf(HasSubstr("3 of 83 points left out"), HasSubstr("40 of 83 points left out")));
}

TEST(TextReader, AFewFarPointsDoNotTakeTheDigitsOfTheOthers) {
  EXPECT_EQ(read_content("a.xyz", "0 0 0\n1 2 3\n").cloud.size(), 2U);
  std::string text;
  for (int i = 0; i < 20; ++i) text += fmt::format("50000{}.123 46000{:02}.456 100.5\n", i % 10, i);
  for (const char* stray : {"0 0 0\n", "5e8 0 0\n", "500000 4600000 -9e7\n"}) {
    const auto far = read_content("a.xyz", stray + text);
    ASSERT_EQ(far.cloud.size(), 21U);
    EXPECT_LT((point(far, 1) - Eigen::Vector3d(500000.123, 4600000.456, 100.5)).norm(), 1e-5) << stray;
    EXPECT_LT((point(far, 20) - Eigen::Vector3d(500009.123, 4600019.456, 100.5)).norm(), 1e-5) << stray;
  }
}

TEST(TextReader, DoesNotDependOnTheLocale) {
  if (std::setlocale(LC_ALL, "de_DE.UTF-8") == nullptr) std::setlocale(LC_ALL, "C");
  EXPECT_EQ(point(read_content("a.xyz", "1.5 2.5 3.5\n"), 0), Eigen::Vector3d(1.5, 2.5, 3.5));
  std::setlocale(LC_ALL, "C");
}

TEST(TextReader, ManyLines) {
  std::string text;
  constexpr std::size_t kLines = 200000;
  for (std::size_t i = 0; i < kLines; ++i)
    text += std::to_string(i) + " 0.5 0.25 " + std::to_string(i % 256) + " 2 3\n";
  const auto file = read_content("many.txt", text);
  ASSERT_EQ(file.cloud.size(), kLines);
  const auto& colors = std::get<Array<Rgb8>>(file.cloud.colors);
  for (std::size_t i = 0; i < kLines; ++i) {
    ASSERT_EQ(point(file, i).x(), static_cast<double>(i));
    ASSERT_EQ(colors[i][0], i % 256);
  }
}

TEST(TextReader, BadLines) {
  const std::pair<std::string, std::string> kCases[] = {
      {"1 2\n", "line 1: 2 columns; at least x y z expected"},
      {"1 2 3\n4 5\n", "line 2: 2 columns where 3 were expected"},
      {"1 2 3\n\n# c\n4 5 six\n", "line 4: column 3: 'six' is not a number"},
      {"x y z\nfoo bar baz\n", "line 2: 'foo' is not a number"},
      {"x y z r\n1 2 3\n", "line 2: 3 columns, but the header line names 4"},
      {"1,,3\n4,5,6\n", "line 1: column 2: '' is not a number"},
      {"1.5;2,5;3,5\n", "line 1: mixes ';' and ','; decimal commas"},
      {"1,2 3,4.5\n", "line 1: mixes ',' and blanks; decimal commas"},
      {"x y z r g b\n1 2 3 0 0 70000\n", "point 1: blue = 70000"},
      {"x y z r g b\n1 2 3 0 0 -1\n", "point 1: blue = -1"},
      {"a,b,c\n1,2,3\n", "line 1: the header names no coordinates"},
      {"lat,lon,height\n1,2,3\n", "longitude and latitude"},
      {"3\n1 2 3\n4 5 6\n", "truncated: a line announces 3 points, but 2 follow"},
      {"1 2 3\n4 5 6\n7\n", "line 3: 1 column"},
      {"# only a comment\n", "holds no line of numbers"},
      {"x y z\n", "holds no line of numbers"},
      {"\n\n", "holds no line of numbers"},
      {"nan nan nan\n", "none of its 1 points is finite"},
      {"0 0 1e15\n", "none of its 1 points is left; 1 left out: no return"},
  };
  for (const auto& [content, message] : kCases) EXPECT_THAT(refusal("bad.xyz", content), HasSubstr(message)) << content;
}

}  // namespace text_reader_test
}  // namespace cmap::testing

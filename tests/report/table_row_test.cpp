#include "table_row.hpp"

#include "cmap/report/table_text.hpp"
#include "report/table_testing.hpp"

namespace cmap {
namespace table_row_test {

using test::lines_of;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::SizeIs;

const std::string kLevels(31, '#');    // as wide as the three columns
constexpr std::size_t kRemarkAt = 99;  // where a remark beside levels stands

TableRow row_with(const std::string& remark, const std::string& levels = kLevels) {
  return {
      .title = "title", .symbol = "S", .arrow = "↓", .value = "1.000", .unit = "m", .levels = levels, .remark = remark};
}

TEST(TableRow, StandsInItsColumns) {
  EXPECT_EQ(format_row(row_with("remark", ""), 0),
            "  title                          S        ↓       1.000 m          remark\n");
  EXPECT_EQ(format_row(row_with("", ""), 0), "  title                          S        ↓       1.000 m\n");
}

TEST(TableRow, WithoutLevelsOrWidthIsOneLine) {
  const std::string remark(200, 'x');
  EXPECT_THAT(lines_of(format_row(row_with(remark, ""), 80)), ElementsAre(EndsWith("m          " + remark)));
  EXPECT_THAT(lines_of(format_row(row_with(remark), 0)), ElementsAre(EndsWith("#  " + remark)));
}

TEST(TableRow, ARemarkThatFitsStandsBesideTheLevels) {
  const std::string remark = "ten words and an Å";  // 18 characters, 19 bytes
  const auto lines = lines_of(format_row(row_with(remark), kRemarkAt + 18));
  ASSERT_THAT(lines, SizeIs(1));
  EXPECT_EQ(test::column_of(lines[0], lines[0].find(remark)), kRemarkAt);
}

TEST(TableRow, ALongRemarkGoesOnInItsColumn) {
  const std::string indent(kRemarkAt, ' ');
  const std::string remark = "189 voxels of 3 m, >= 100 points; 0.169 ± 0.010 over 8 grids";
  EXPECT_THAT(lines_of(format_row(row_with(remark), kRemarkAt + 41)),
              ElementsAre(EndsWith("#  189 voxels of 3 m, >= 100 points;"), indent + "0.169 ± 0.010 over 8 grids"))
      << "cut after a part of the sentence";
  EXPECT_THAT(lines_of(format_row(row_with("one two three four five six seven eight nine"), kRemarkAt + 30)),
              ElementsAre(EndsWith("#  one two three four five six"), indent + "seven eight nine"));
  EXPECT_THAT(lines_of(format_row(row_with("12,345,678 voxels of 0.1 m and more"), kRemarkAt + 30)),
              ElementsAre(EndsWith("#  12,345,678 voxels of 0.1 m and"), indent + "more"))
      << "a number is not cut";
}

TEST(TableRow, WhereTheColumnIsNarrowItStandsBelowTheTitle) {
  EXPECT_THAT(lines_of(format_row(row_with("a remark that does not fit there"), kRemarkAt + 29)),
              ElementsAre(EndsWith("#"), "    a remark that does not fit there"));
  EXPECT_THAT(lines_of(format_row(row_with("short"), kRemarkAt + 5)), ElementsAre(EndsWith("#  short")));
}

TEST(TableRow, NoRemarkIsWiderThanItsLine) {
  const std::string remark = "39,462 voxels of 0.1 m, 37,084 of one point as 0; without them 0.01290   tau 0.1 ± 0.2";
  for (std::size_t width = 60; width < kRemarkAt + 100; ++width) {
    std::string words;
    const auto lines = lines_of(format_row(row_with(remark), width));
    for (std::size_t i = 0; i < lines.size(); ++i) {
      EXPECT_LE(character_count(lines[i]), i == 0 ? std::max(width, kRemarkAt) : width) << lines[i];
      words += lines[i] + " ";
    }
    std::erase(words, ' ');
    std::string wanted = remark;
    std::erase(wanted, ' ');
    EXPECT_THAT(words, HasSubstr(wanted)) << width;
  }
}

TEST(TableRow, AWordThatIsLongerThanTheLineStaysWhole) {
  const std::string word(80, 'x');
  EXPECT_THAT(lines_of(format_row(row_with("a " + word + " b"), 40)),
              ElementsAre(EndsWith("#"), "    a", "    " + word, "    b"));
  EXPECT_THAT(lines_of(format_row(row_with(word), 3)), ElementsAre(EndsWith("#"), "    " + word));
}

}  // namespace table_row_test
}  // namespace cmap

#include <algorithm>
#include <cctype>
#include <sstream>

#include "report/table_testing.hpp"

namespace cmap {
namespace table_test {

using test::column_of;
using test::gray_map;
using test::line_with;
using test::lines_of;
using test::options_for;
using test::painted_sheet;
using test::report_of;
using test::small_map;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

std::string full_table() {
  EvaluationOptions options = options_for({"all"});
  options.mme_radius_m = 0.5;
  options.awd_min_points = 20;
  return format_table(report_of(painted_sheet(4000, 1), painted_sheet(3000, 2), options));
}

TEST(Table, StartsWithBothMaps) {
  const std::string table = format_table(report_of(painted_sheet(4000, 1), painted_sheet(3000, 2)));
  EXPECT_THAT(table, StartsWith("reference ref.ply: 4,000 points, PLY ascii, color u8\n"
                                "estimate  est.ply: 3,000 points, PLY ascii, color u8\n"));
}

TEST(Table, CountsOnePoint) {
  const std::string table = format_table(report_of(gray_map({{0, 0, 0}}), gray_map({{0, 0, 1}, {0, 1, 0}})));
  EXPECT_THAT(table, StartsWith("reference ref.ply: 1 point, PLY ascii"));
  EXPECT_THAT(table, HasSubstr("est.ply: 2 points,"));
}

TEST(Table, ASmallShareIsNotShownAsZero) {
  auto report = report_of(gray_map({{0, 0, 0}}), gray_map({{0, 0, 0}}), options_for({"overlap"}));
  const auto shown = [&](double share) {
    report["metrics"]["overlap"]["value"] = share;
    return line_with(format_table(report), "Overlap");
  };
  EXPECT_THAT(shown(0.0), HasSubstr(" 0.00 %"));
  EXPECT_THAT(shown(4e-5), HasSubstr(" < 0.01 %"));
  EXPECT_THAT(shown(6e-5), HasSubstr(" 0.01 %"));
}

TEST(Table, ShowsEveryMetricUnderItsGroup) {
  const std::string table = full_table();
  std::size_t place = 0;
  for (const char* text : {"\ncolor\n",
                           "color distance",
                           "CF",
                           "LCR",
                           "CCS",
                           "\ncolor+\n",
                           "dE00",
                           "CD at 0 to 0.05 m",
                           "CD at 0.5 to 1 m",
                           "exposure-free",
                           "PSNR",
                           "\ngeometry\n",
                           "Chamfer distance",
                           "accuracy",
                           "fitness (precision)",
                           "completeness (recall)",
                           "F-score",
                           "Overlap",
                           "Hausdorff",
                           "RMSE",
                           "\ndistribution\n",
                           "AWD",
                           "SCS",
                           "\nentropy\n",
                           "MME"}) {
    place = table.find(text, place);
    ASSERT_NE(place, std::string::npos) << text << " in\n" << table;
  }
}

TEST(Table, ArrowsStandInOneColumn) {
  std::ptrdiff_t column = -1;
  int rows = 0;
  for (const std::string& line : lines_of(full_table())) {
    const std::size_t arrow = std::min(line.find("↓"), line.find("↑"));
    if (arrow == std::string::npos) continue;
    if (rows++ == 0) column = column_of(line, arrow);
    EXPECT_EQ(column_of(line, arrow), column) << line;
  }
  const auto directed = [](const Metric* metric) { return !metric->info.better.empty(); };
  EXPECT_EQ(rows, std::ranges::count_if(metric_list(), directed) + 4) << "one of them in 5 ranges";
}

/// The words of a line with the columns where they end, from a first column on.
std::vector<std::pair<std::string, std::ptrdiff_t>> words_of(const std::string& line, std::ptrdiff_t from) {
  std::vector<std::pair<std::string, std::ptrdiff_t>> words;
  std::istringstream stream(line);
  for (std::string word; stream >> word;) {
    const std::size_t place = stream.eof() ? line.size() : static_cast<std::size_t>(stream.tellg());
    if (const std::ptrdiff_t end = column_of(line, place); end > from) words.emplace_back(word, end);
  }
  return words;
}

TEST(Table, ValuesEndInOneColumn) {
  std::ptrdiff_t column = -1;
  for (const std::string& line : lines_of(full_table())) {
    const std::size_t arrow = std::min(line.find("↓"), line.find("↑"));
    if (arrow == std::string::npos) continue;
    const auto [value, end] = words_of(line, column_of(line, arrow) + 1).front();
    EXPECT_TRUE(std::isdigit(static_cast<unsigned char>(value.back()))) << line;
    if (column < 0) column = end;
    EXPECT_EQ(end, column) << line;
  }
  EXPECT_GT(column, 0);
}

/// Where the numbers of a row end, or the units of a line of thresholds.
std::vector<std::ptrdiff_t> ends_of_numbers(const std::string& line) {
  std::vector<std::ptrdiff_t> ends;
  for (const auto& [word, end] : words_of(line, 42)) {
    if (word == "-" || std::isdigit(static_cast<unsigned char>(word.front()))) ends.push_back(end);
  }
  return ends;
}

TEST(Table, ThresholdsStandAboveTheirValues) {
  EvaluationOptions options = options_for({"geometry"});
  for (const std::vector<double>& thresholds : {std::vector<double>{0.2, 0.1, 0.05}, {0.123456, 100.5, 12345.5, 1.0}}) {
    options.thresholds_m = thresholds;
    const std::string table = format_table(report_of(painted_sheet(400, 1), painted_sheet(300, 2), options));
    std::vector<std::ptrdiff_t> expected;
    for (const auto& [word, end] : words_of(line_with(table, "<="), 0)) {
      if (word == "m") expected.push_back(end);
    }
    EXPECT_EQ(expected.size(), thresholds.size()) << table;
    for (const char* title : {"accuracy", "fitness", "completeness", "F-score"}) {
      EXPECT_EQ(ends_of_numbers(line_with(table, title)), expected) << table;
    }
  }
}

TEST(Table, DirectionsPointTheRightWay) {
  const std::string table = full_table();
  for (const char* lower : {"CD ", "CCS", "CD#", "AC", "RMSE", "AWD", "SCS", "MME"})
    EXPECT_THAT(line_with(table, lower), HasSubstr("↓"));
  for (const char* higher : {"CF", "LCR", "COM", "Overlap"}) EXPECT_THAT(line_with(table, higher), HasSubstr("↑"));
}

TEST(Table, RecallStandsBesideItsCoverage) {
  // 2 of 4 points covered, 1 of them recalled.
  const PointCloud reference = gray_map({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}});
  const PointCloud estimate = small_map({{0, 0, 0}, {1, 0, 0}}, {Rgb8{128, 128, 128}, Rgb8{255, 0, 0}});
  const std::string line = line_with(format_table(report_of(reference, estimate)), "LCR");
  EXPECT_THAT(line, ContainsRegex("25.00 % +coverage 50.00 %, of it 50.00 % +tau 0.1, r 0.5 m"));
}

TEST(Table, ParametersThatMatterAreShown) {
  const std::string table = full_table();
  EXPECT_THAT(line_with(table, "CCS"), ContainsRegex("voxels of 0.1 m, [0-9,]+ of one point as 0; without them [0-9]"));
  EXPECT_THAT(line_with(table, "AWD"), ContainsRegex("voxels of 3 m, >= 20 points"));
  EXPECT_THAT(line_with(table, "Overlap"), HasSubstr("within 1 m"));
  EXPECT_THAT(line_with(table, "SCS"), HasSubstr("within 5 voxels"));
  EXPECT_THAT(line_with(table, "MME"), HasSubstr("r 0.5 m"));
}

TEST(Table, ConsistencyNamesItsRule) {
  EvaluationOptions options = options_for({"CCS"});
  options.ccs_voxel_m = 100.0;
  const auto line = [&] {
    return line_with(format_table(report_of(painted_sheet(400, 1), painted_sheet(300, 2), options)), "CCS");
  };
  EXPECT_THAT(line(), ContainsRegex("voxels of 100 m, 0 of one point as 0; without them "));
  options.ccs_singletons = Singletons::kExclude;
  EXPECT_THAT(line(), ContainsRegex("voxels of 100 m, >= 2 points$"));
}

TEST(Table, FlatNeighborhoodsAreCounted) {
  std::vector<Eigen::Vector3f> positions;  // a sheet of paper, and a cube
  for (int i = 0; i < 25; ++i) positions.push_back({static_cast<float>(i % 5), static_cast<float>(i / 5), 0});
  for (int i = 0; i < 27; ++i) {
    positions.push_back({static_cast<float>(i % 3), static_cast<float>(i / 3 % 3), 100.0f + static_cast<float>(i / 9)});
  }
  EvaluationOptions options = options_for({"mme"});
  options.mme_radius_m = 3.0;
  options.mme_min_neighbors = 5;
  const std::string table = format_table(report_of(small_map(positions), small_map(positions), options));
  EXPECT_THAT(line_with(table, "MME"), HasSubstr(", 25 flat left out"));
}

TEST(Table, UnitsFollowTheirValues) {
  const std::string table = full_table();
  EXPECT_THAT(line_with(table, "Chamfer"), ContainsRegex("[0-9] m "));
  EXPECT_THAT(line_with(table, " CF "), ContainsRegex("[0-9] dB"));
  EXPECT_THAT(line_with(table, "color distance  "), ContainsRegex("[0-9] unit RGB "));
  EXPECT_THAT(line_with(table, "MME"), ContainsRegex("[0-9] nats"));
}

TEST(Table, FourSignificantDigits) {
  const auto rmse_shown = [](float distance) {
    return line_with(
        format_table(report_of(gray_map({{0, 0, 0}}), gray_map({{0, 0, distance}}), options_for({"rmse"}))), "RMSE");
  };
  EXPECT_THAT(rmse_shown(0.0f), ContainsRegex("↓ +0 m"));
  EXPECT_THAT(rmse_shown(1.0f), ContainsRegex("↓ +1.000 m"));
  EXPECT_THAT(rmse_shown(0.0123456f), ContainsRegex("↓ +0.01235 m"));
  EXPECT_THAT(rmse_shown(123.456f), ContainsRegex("↓ +123.5 m"));
  EXPECT_THAT(rmse_shown(999.96f), ContainsRegex("↓ +1000 m")) << "rounding adds a digit, not a decimal";
  EXPECT_THAT(rmse_shown(123456.0f), ContainsRegex("↓ +123456 m"));
  EXPECT_THAT(rmse_shown(0.000012345f), ContainsRegex("↓ +1.23[45]e-05 m"));
}

TEST(Table, MissingValuesAreADash) {
  EvaluationOptions options = options_for({"all"});
  options.as = test::tools({"color-map-evaluation", "cloudanalyzer", "mapeval", "open3d", "mpeg", "cloudcompare"});
  const std::string table = format_table(report_of(small_map({{0, 0, 0}}), small_map({{100, 0, 0}}), options));
  for (const char* symbol : {" CD ", " LCR ", " CCS ", " AC ", " AWD ", " MME "}) {
    EXPECT_THAT(line_with(table, symbol), ContainsRegex("(↓|↑) +-( |$)"));
  }
  for (const char* bad : {" nan", "NaN", " inf", "null"}) {
    EXPECT_THAT(table.substr(0, table.find("\nwarnings\n")), Not(HasSubstr(bad)));
  }
}

TEST(Table, OtherToolsFollowByName) {
  EvaluationOptions options = options_for({"chamfer"});
  options.as = test::tools({"cloudcompare", "open3d"});
  const std::string table = format_table(report_of(gray_map({{0, 0, 0}}), gray_map({{0, 0, 0.5f}}), options));
  EXPECT_LT(table.find("\nas cloudcompare\n"), table.find("\nas open3d\n"));
  EXPECT_THAT(line_with(table, " mean "), ContainsRegex("mean +0.5"));
  EXPECT_THAT(line_with(table, "@ 0.2 m fitness"), ContainsRegex(" 0(.0)?$"));
}

TEST(Table, OfOneMap) {
  EvaluationOptions options;
  options.mme_radius_m = 0.5;
  const std::string table = format_table(test::map_report_of(painted_sheet(4000, 1), options));
  EXPECT_THAT(table, StartsWith("map       map.ply: 4,000 points, PLY ascii, color u8\n\ncolor\n"));
  EXPECT_THAT(line_with(table, "CCS"), ContainsRegex("↓ +[0-9.]+ unit RGB\\^2"));
  EXPECT_THAT(line_with(table, "MME"), ContainsRegex("nats +r 0.5 m$")) << "no reference beside it";
  EXPECT_THAT(table, HasSubstr("\ndensity\n"));
  EXPECT_THAT(line_with(table, "point spacing"),
              ContainsRegex("point spacing +[0-9.]+ m +4,000 places, mean [0-9.]+$"));
}

TEST(Table, AnInfiniteFidelityIsNoDash) {
  const PointCloud map = gray_map({{0, 0, 0}, {1, 0, 0}});
  EXPECT_THAT(line_with(format_table(report_of(map, map)), "CF"), ContainsRegex("↑ +infinity dB$"));
  EXPECT_THAT(line_with(format_table(report_of(map, small_map({{0, 0, 0}}))), "CF"), ContainsRegex("↑ +-"))
      << "no color";
}

TEST(Table, WarningsStandAtTheEnd) {
  const std::string table =
      format_table(report_of(gray_map({{0, 0, 0}, {1, 0, 0}}), gray_map({{50, 0, 0}, {51, 0, 0}})));
  const std::vector<std::string> lines = lines_of(table);
  const auto heading = std::ranges::find(lines, "warnings");
  ASSERT_NE(heading, lines.end());
  EXPECT_GT(std::distance(heading, lines.end()), 2);
  for (auto line = heading + 1; line != lines.end(); ++line) EXPECT_THAT(*line, ContainsRegex("^  [a-z_]+: .+"));
  EXPECT_THAT(table, HasSubstr("\n  no_overlap: no estimated point is within the overlap distance of the reference\n"));
}

TEST(Table, HasNoWarningsWhereThereAreNone) {
  EXPECT_THAT(format_table(report_of(gray_map({{0, 0, 0}}), gray_map({{0, 0, 0}}), options_for({"geometry"}))),
              Not(HasSubstr("warnings")));
}

TEST(Table, HasNoTrailingBlanks) {
  for (const std::string& line : lines_of(full_table())) {
    EXPECT_TRUE(line.empty() || line.back() != ' ') << "\"" << line << "\"";
  }
}

TEST(Table, IsMadeFromASavedReport) {
  const nlohmann::ordered_json report = report_of(painted_sheet(400, 1), painted_sheet(300, 2), options_for({"all"}));
  EXPECT_EQ(format_table(nlohmann::ordered_json::parse(report.dump())), format_table(report));
}

}  // namespace table_test
}  // namespace cmap

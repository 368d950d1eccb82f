// The table with what its numbers are worth; the levels are written into reports by hand.

#include "levels_table.hpp"

#include "cmap/report/table_text.hpp"
#include "report/table_testing.hpp"

namespace cmap {
namespace levels_table_test {

using Json = nlohmann::ordered_json;
using test::column_of;
using test::line_with;
using test::lines_of;
using test::options_for;
using test::painted_sheet;
using test::report_of;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

Json level(double value) { return {{"value", value}, {"se", 0.001}, {"n", 100}}; }
Json missing(const std::string& reason) { return {{"value", nullptr}, {"n", 3}, {"reason", reason}}; }

Json phases(std::vector<Json> values, Json n, Json mean, Json std) {
  return {{"n", std::move(n)}, {"mean", std::move(mean)}, {"std", std::move(std)}, {"values", std::move(values)}};
}

Json evaluated_without_levels() {
  EvaluationOptions options = options_for({"all"});
  options.mme_radius_m = 0.5;
  options.awd_min_points = 20;
  Json report = report_of(painted_sheet(4000, 1), painted_sheet(3000, 2), options);
  for (Json& record : report["metrics"]) {
    for (const char* member : {"floor", "chance", "skill", "phases"}) {
      record.erase(member);
      if (record.contains("per_threshold")) {
        for (Json& entry : record["per_threshold"]) entry.erase(member);
      }
    }
  }
  return report;
}

/// Every metric, without a level.
const Json& bare() {
  static const Json report = evaluated_without_levels();
  return report;
}

/// What is there of every kind of level.
Json leveled() {
  Json report = bare();
  Json& metrics = report["metrics"];
  metrics["color_distance"].update({{"floor", level(0.0881)}, {"chance", level(0.4154)}, {"skill", level(0.82749)}});
  metrics["local_color_recall"].update({{"floor", level(0.991)}, {"chance", level(0.786)}, {"skill", level(-0.5)}});
  metrics["color_consistency"].update({{"floor", level(0.0117)}, {"chance", level(0.0913)}});
  metrics["chamfer"]["floor"] = level(0.2272);
  for (const char* id : {"accuracy", "fitness", "completeness", "f_score"}) {
    double floor = 0.8;
    for (Json& entry : metrics[id]["per_threshold"]) entry["floor"] = level(floor /= 2.0);
  }
  metrics["average_wasserstein"]["phases"] = phases({0.5, 0.2, 0.3, 0.3, 0.3, 0.3, 0.3, 0.2}, 8, 0.298, 0.097);
  return report;
}

std::string table_of(const Json& report, std::size_t width = 0) {
  return format_table(report, {.levels = true, .width = width});
}

/// The table of a report with something done to it.
template <class Change>
std::string table_after(Change&& change) {
  Json report = leveled();
  change(report["metrics"]);
  return table_of(report);
}

/// Where these words of a line end.
std::vector<std::ptrdiff_t> ends_of(const std::string& line, const std::vector<std::string>& words) {
  std::vector<std::ptrdiff_t> ends;
  for (const std::string& word : words) {
    const std::size_t place = line.find(" " + word);
    EXPECT_NE(place, line.npos) << word << " in " << line;
    ends.push_back(column_of(line, place + 1 + word.size()));
  }
  return ends;
}

TEST(LevelsTable, LevelsStandUnderTheirNames) {
  const std::string table = table_of(leveled());
  const auto heading = ends_of(line_with(table, "floor     chance    skill"), {"floor", "chance", "skill"});
  EXPECT_EQ(ends_of(line_with(table, "color distance  "), {"0.08810", "0.4154", "0.827"}), heading);
  EXPECT_EQ(ends_of(line_with(table, " LCR "), {"99.10", "78.60", "-0.500"}), heading)
      << "shares in percent, as the value";
  const std::string chamfer = line_with(table, "Chamfer");
  EXPECT_EQ(ends_of(chamfer, {"0.2272"}), std::vector{heading[0]});
  EXPECT_EQ(column_of(chamfer, chamfer.find("estimate ")), heading[2] + 2) << "a remark stands where others do";
}

TEST(LevelsTable, NamesStandAboveGroupsThatHaveColumns) {
  const std::string table = table_of(leveled());
  EXPECT_THAT(table, ContainsRegex("\ncolor +value +floor +chance +skill\n"));
  EXPECT_THAT(table, ContainsRegex("\ngeometry +value +floor +chance +skill\n"));
  EXPECT_THAT(table, HasSubstr("\nentropy\n"));
  EXPECT_THAT(table, HasSubstr("\ndistribution\n")) << "phases are no column";
}

TEST(LevelsTable, WithoutLevelsItIsAsBefore) {
  const std::string plain = format_table(bare());
  EXPECT_EQ(table_of(bare()), plain) << "a report without";
  EXPECT_EQ(table_of(bare(), 200), plain);
  Json no_band = leveled();
  no_band["metrics"]["average_wasserstein"].erase("phases");
  EXPECT_EQ(format_table(no_band), plain) << "not asked for";
  EXPECT_EQ(format_table(no_band, {.levels = false, .width = 60}), plain);
}

TEST(LevelsTable, FloorsAtThresholdsStandUnderTheirValues) {
  const auto lines = lines_of(table_of(leveled()));
  const auto words = [](const std::string& line) {
    std::istringstream stream(line);
    return std::vector<std::string>(std::istream_iterator<std::string>(stream), {});
  };
  int rows = 0;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    if (!lines[i].starts_with("    floor ")) continue;
    ++rows;
    EXPECT_EQ(lines[i].size(), lines[i].find_last_not_of(' ') + 1);
    const std::vector<std::string> floors = words(lines[i]);
    const bool share = floors.back() == "%";
    ASSERT_EQ(floors.size(), 7u) << lines[i];
    EXPECT_EQ(floors[1], share ? "40.00" : "0.4000");
    EXPECT_EQ(floors[5], share ? "2.50" : "0.02500");
    // Its last number and its unit end where those of the values do, of which the arrow is 3 bytes.
    EXPECT_EQ(lines[i].size(), static_cast<std::size_t>(column_of(lines[i - 1], lines[i - 1].size())));
  }
  EXPECT_EQ(rows, 4);
  EXPECT_THAT(format_table(leveled()), Not(HasSubstr("    floor ")));
}

TEST(LevelsTable, AMissingLevelIsADashAndSaysWhyBelow) {
  const std::string table = table_after([](Json& metrics) {
    metrics["local_color_recall"]["skill"] = {{"value", nullptr}, {"reason", "the floor is no better than chance"}};
  });
  EXPECT_THAT(line_with(table, " LCR "), ContainsRegex(" 78.60 +-  coverage"));
  EXPECT_THAT(table, HasSubstr("\nlevels without a value\n  skill of LCR: the floor is no better than chance\n"));
  EXPECT_THAT(table_of(leveled()), Not(HasSubstr("without a value")));
}

TEST(LevelsTable, OneReasonIsSaidOnce) {
  const std::string table = table_after([](Json& metrics) {
    for (const char* id : {"color_distance", "chamfer"}) metrics[id]["floor"] = missing("one point");
    metrics["local_color_recall"]["floor"] = missing("another one");
    for (const char* id : {"accuracy", "completeness"}) {
      for (Json& entry : metrics[id]["per_threshold"]) entry["floor"] = missing("one point");
    }
    metrics["fitness"]["per_threshold"][4]["floor"] = missing("one point");
    metrics["color_distance"]["chance"] = missing("one point");
  });
  EXPECT_THAT(table, HasSubstr("  floor of CD, CD#, AC, COM at 0.01 m, completeness (recall): one point\n"
                               "  chance of CD: one point\n"
                               "  floor of LCR: another one\n"));
}

TEST(LevelsTable, ALevelWithoutAReasonIsStillSaid) {
  const std::string table = table_after([](Json& metrics) { metrics["chamfer"]["floor"] = {{"value", nullptr}}; });
  EXPECT_THAT(table, HasSubstr("  floor of CD#: no reason given\n"));
}

TEST(LevelsTable, PhasesStandInTheRemarkWithLevelsAndWithout) {
  for (const bool levels : {false, true}) {
    EXPECT_THAT(line_with(format_table(leveled(), {.levels = levels}), "AWD"),
                ContainsRegex("voxels of 3 m, >= 20 points; 0.298 ± 0.097 over 8 grids$"));
  }
  const std::string without_value =
      table_after([](Json& metrics) { metrics["average_wasserstein"]["value"] = nullptr; });
  EXPECT_THAT(line_with(without_value, "AWD"), ContainsRegex("- m +0.298 ± 0.097 over 8 grids$"));
}

TEST(LevelsTable, ABandHasTheDigitsThatItsDeviationLeaves) {
  const auto band = [](Json mean, Json std) {
    return phases_text({{"phases", phases({1, 2, 3}, 3, std::move(mean), std::move(std))}});
  };
  EXPECT_EQ(band(0.298, 0.097), "0.298 ± 0.097 over 3 grids");
  EXPECT_EQ(band(0.16949, 0.0104), "0.169 ± 0.010 over 3 grids");
  EXPECT_EQ(band(12.345, 1.55), "12.3 ± 1.6 over 3 grids");
  EXPECT_EQ(band(1234.6, 321.0), "1235 ± 321 over 3 grids") << "all digits before the point";
  EXPECT_EQ(band(0.298, 0.0), "0.2980 ± 0 over 3 grids");
  EXPECT_EQ(band(0.298, 1.2e-12), "0.2980 ± 1.200e-12 over 3 grids");
}

TEST(LevelsTable, ABandSaysOfHowManyGridsItIs) {
  EXPECT_EQ(phases_text({{"phases", phases({nullptr, 2, 3}, 2, 2.5, 0.5)}}), "2.50 ± 0.50 over 2 of 3 grids");
  EXPECT_EQ(phases_text({{"phases", phases({nullptr, nullptr}, 0, nullptr, nullptr)}}), "") << "no grid has a value";
  EXPECT_EQ(phases_text(Json::object()), "");
}

TEST(LevelsTable, LinesKeepToTheWidth) {
  const std::size_t widest_columns = 104;  // of five thresholds
  for (std::size_t width = 80; width < 200; ++width) {
    const std::string table = table_of(leveled(), width);
    const auto lines = lines_of(table.substr(table.find("\ncolor")));
    for (const std::string& line : lines) {
      if (line == "warnings") break;
      EXPECT_LE(character_count(line), std::max(width, widest_columns)) << width;
    }
  }
  EXPECT_THAT(lines_of(table_of(leveled(), kWidthForLevels)),
              Not(::testing::Contains(::testing::StartsWith("    cover"))))
      << "at the width from which levels are shown, remarks stand beside them";
}

}  // namespace levels_table_test
}  // namespace cmap

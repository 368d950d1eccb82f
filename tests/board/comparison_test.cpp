#include "board/comparison_testing.hpp"

namespace cmap {
namespace comparison_test {

using test::refusal_of;
using test::saved;
using test::some_report;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::ordered_json;

/// Three reports whose Chamfer distances are 2, 1 and missing, and whose overlaps are 0.5, 0.5 and 0.25.
std::vector<SavedReport> three_reports() {
  std::vector<SavedReport> reports;
  const std::vector<std::pair<Json, double>> values{{2.0, 0.5}, {1.0, 0.5}, {nullptr, 0.25}};
  for (const auto& [chamfer, overlap] : values) {
    Json report = some_report();
    report["metrics"]["chamfer"]["value"] = chamfer;
    report["metrics"]["overlap"]["value"] = overlap;
    reports.push_back(saved(std::string(1, static_cast<char>('a' + reports.size())), report));
  }
  return reports;
}

std::string compared(const ComparisonOptions& options, ComparisonFormat format = ComparisonFormat::kText) {
  return format_comparison(three_reports(), options, format);
}

TEST(FormatComparison, MarksBestAndSecondBestOfEachRow) {
  const std::string table = compared({{"chamfer", "overlap"}, {}, true});
  EXPECT_THAT(table, ContainsRegex("Chamfer distance +CD# +↓ +m +2.000\\+ +1.000\\* +-\n"));
  EXPECT_THAT(table, ContainsRegex("overlap +Overlap +↑ +% +50.00\\* +50.00\\* +25.00\\+\n"));
  EXPECT_THAT(table, HasSubstr("* best, + second best; - no value"));
  EXPECT_THAT(table, Not(HasSubstr("accuracy")));
}

TEST(FormatComparison, OneRowForEachThreshold) {
  const std::string table = compared({{"accuracy"}, {}});
  for (const char* threshold : {"0.2", "0.1", "0.08", "0.05", "0.01"}) {
    EXPECT_THAT(table, HasSubstr(std::string("accuracy <= ") + threshold + " m"));
  }
}

TEST(FormatComparison, DifferencesSayWhatIsBetter) {
  const std::string table = compared({{"chamfer", "overlap"}, 0});
  EXPECT_THAT(table, HasSubstr("Better (+) or worse (-) than a\n"));
  EXPECT_THAT(table, ContainsRegex("Chamfer distance .*\\+1.000 \\(\\+50.0 %\\) +-\n")) << "1 m less is better";
  EXPECT_THAT(table, ContainsRegex("overlap .* 0 \\(0 %\\) +-25.00 \\(-50.0 %\\)\n")) << "in points of percent";
  const std::string other = compared({{"chamfer"}, 1});
  EXPECT_THAT(other, ContainsRegex("Chamfer distance .*-1.000 \\(-100.0 %\\) +-\n"));
}

TEST(FormatComparison, CsvHasAllDigitsAndNoZeros) {
  EXPECT_EQ(compared({{"chamfer", "overlap"}, 0}, ComparisonFormat::kCsv),
            "metric,part,at_m,unit,better,a,b,c,b: better by,\"b: better by, relative\",c: better by,\"c: better by, "
            "relative\",ranking\n"
            "chamfer,,,m,lower,2,1,,1,0.5,,,not tested\n"
            "overlap,,,1,higher,0.5,0.5,0.25,0,0,-0.25,-0.5,not tested\n");
  EXPECT_EQ(compared({{"chamfer"}, {}, true}, ComparisonFormat::kCsv),
            "metric,part,at_m,unit,better,a,b,c\n"
            "chamfer,,,m,lower,2,1,\n");
}

TEST(FormatComparison, WhatNobodyTestedIsMarkedSo) {
  const std::string table = compared({{"chamfer", "overlap"}, {}});
  EXPECT_THAT(table, ContainsRegex("Chamfer distance +CD# +↓ +m +2.000 +1.000\\? +-\n"));
  EXPECT_THAT(table, ContainsRegex("overlap +Overlap +↑ +% +50.00\\? +50.00\\? +25.00\n"));
  EXPECT_THAT(table, HasSubstr("* best, + second best, ? best by value alone, not tested; - no value\n"
                               "0 of 2 rankings distinguishable, 2 not tested (no --bootstrap)\n"));
  EXPECT_THAT(compared({{"chamfer"}, {}}, ComparisonFormat::kMarkdown), HasSubstr("| 2.000 | 1.000? | - |"));
  const std::string latex = compared({{"chamfer"}, {}}, ComparisonFormat::kLatex);
  EXPECT_THAT(latex, HasSubstr("2.000 & \\cellcolor{gray!25}1.000 & --"));
  EXPECT_THAT(latex, HasSubstr("gray best by value alone, not tested"));
  const std::string page = compared({{"chamfer"}, {}}, ComparisonFormat::kHtml);
  EXPECT_THAT(page, HasSubstr("class=\"value untested\" data-value=\"1\""));
  EXPECT_THAT(page, HasSubstr("<span class=\"untested\">best by value alone, not tested</span>"));
  EXPECT_THAT(compared({{"chamfer"}, {}, true}, ComparisonFormat::kHtml), Not(HasSubstr("not tested")));
}

/// What a record of a color distance holds besides: worth 0.75 of the way from chance to the floor.
void add_levels(Json& record, double skill) {
  record["floor"] = {{"value", 0.0625}, {"se", 0.001}, {"n", 300}};
  record["chance"] = {{"value", 0.5}, {"se", 0.001}, {"n", 300}};
  record["skill"] = {{"value", skill}, {"se", 0.002}};
}

void add_phases(Json& record, const std::vector<double>& values, double std) {
  record["phases"] = {{"n", values.size()}, {"mean", 0.3}, {"std", std},
                      {"min", 0.2},         {"max", 0.4},  {"values", values}};
}

/// Two reports with skills; AWD of the second is worse by the world's grid and better by another.
std::vector<SavedReport> reports_with_levels() {
  std::vector<SavedReport> reports = three_reports();
  reports.pop_back();
  for (std::size_t i = 0; i < 2; ++i) {
    Json& metrics = reports[i].json["metrics"];
    add_levels(metrics["color_distance"], i == 0 ? 0.75 : 0.5);
    metrics["average_wasserstein"]["value"] = i == 0 ? 0.25 : 0.3125;
    add_phases(metrics["average_wasserstein"], i == 0 ? std::vector{0.25, 0.375} : std::vector{0.3125, 0.3125},
               0.09712);
    check_report(reports[i].json, "r.json");
  }
  return reports;
}

TEST(FormatComparison, SkillHasARowOfItsOwn) {
  std::vector<SavedReport> reports = reports_with_levels();
  const std::string table = format_comparison(reports, {{"color"}, {}}, ComparisonFormat::kText);
  EXPECT_THAT(table, ContainsRegex("color distance +CD +↓ [^\n]*\nskill of color distance +↑ +0.7500\\? +0.5000\n"));
  Json& skill = reports[1].json["metrics"]["color_distance"]["skill"];
  skill = {{"value", nullptr}, {"reason", "the floor is no better than chance"}};
  const std::string without = format_comparison(reports, {{"CD"}, 0}, ComparisonFormat::kText);
  EXPECT_THAT(without, ContainsRegex("skill of color distance +↑ +0.7500 +-\n"));
  EXPECT_THAT(without, HasSubstr("no skill of color distance: the floor is no better than chance (b)\n"));
  reports[1].json["metrics"]["color_distance"].erase("skill");
  EXPECT_THAT(format_comparison(reports, {{"CD"}, {}}, ComparisonFormat::kText),
              ContainsRegex("skill of color distance +↑ +0.7500 +-\n"))
      << "an older report";
}

TEST(FormatComparison, BandsStandBehindTheirValues) {
  const std::vector<SavedReport> reports = reports_with_levels();
  const auto as = [&](ComparisonFormat format, bool bands = false) {
    return format_comparison(reports, {{"AWD"}, {}, false, bands}, format);
  };
  EXPECT_THAT(as(ComparisonFormat::kText), ContainsRegex("AWD +↓ +m +0.2500\\* ± 0.097 +0.3125\\* ± 0.097\n"));
  EXPECT_THAT(as(ComparisonFormat::kMarkdown), HasSubstr("| **0.2500** ± 0.097 | **0.3125** ± 0.097 |"));
  EXPECT_THAT(as(ComparisonFormat::kHtml), HasSubstr("0.2500 <span class=\"band\">± 0.097</span>"));
  EXPECT_THAT(as(ComparisonFormat::kLatex), Not(HasSubstr("pm")));
  EXPECT_THAT(as(ComparisonFormat::kLatex, true), HasSubstr("\\cellcolor{red!35}0.2500 $\\pm$ 0.097 &"));
}

TEST(FormatComparison, WhatIsNotDistinguishableSharesItsMark) {
  std::vector<SavedReport> reports = reports_with_levels();
  EXPECT_THAT(format_comparison(reports, {{"AWD"}, {}}, ComparisonFormat::kText),
              HasSubstr("0 of 1 ranking distinguishable over the grid's phases, 1 not\n"));
  add_phases(reports[1].json["metrics"]["average_wasserstein"], {0.3125, 0.4375}, 0.09712);
  const std::string table = format_comparison(reports, {{"AWD", "CD"}, {}}, ComparisonFormat::kText);
  EXPECT_THAT(table, ContainsRegex("AWD +↓ +m +0.2500\\* ± 0.097 +0.3125\\+ ± 0.097\n"));
  EXPECT_THAT(
      table,
      HasSubstr("1 of 3 rankings distinguishable over the grid's phases, 1 not, 1 not tested (no --bootstrap)\n"))
      << "the color distances are the same, skill has no test";
}

TEST(FormatComparison, CsvHasLevels) {
  const std::string text = format_comparison(reports_with_levels(), {{"CD", "AWD"}, 0}, ComparisonFormat::kCsv);
  EXPECT_THAT(text, HasSubstr("color_distance,floor,,unit RGB,,0.0625,0.0625,,,\n"
                              "color_distance,chance,,unit RGB,,0.5,0.5,,,\n"
                              "color_distance,skill,,1,higher,0.75,0.5,-0.25,-0.3333333333333333,not tested\n"));
  EXPECT_THAT(text, HasSubstr("average_wasserstein,phase_std,,m,,0.09712,0.09712,,,\n"));
}

TEST(CheckReport, OfLevels) {
  const auto refusal = [](const char* id, auto&& change) {
    std::vector<SavedReport> reports = reports_with_levels();
    change(reports[0].json["metrics"][id]);
    return refusal_of<InputError>([&] { check_report(reports[0].json, "r.json"); });
  };
  EXPECT_EQ(refusal("color_distance", [](Json& r) { r["floor"]["value"] = nullptr; }), "");
  EXPECT_EQ(refusal("color_distance", [](Json& r) { r["floor"]["value"] = "x"; }),
            "r.json: damaged report: metrics.color_distance.floor.value is string, expected a number or null");
  EXPECT_EQ(refusal("color_distance", [](Json& r) { r["skill"] = 1; }),
            "r.json: damaged report: metrics.color_distance.skill is number, expected an object");
  EXPECT_EQ(
      refusal("average_wasserstein",
              [](Json& r) {
                r["phases"]["values"] = {1.0, "x"};
              }),
      "r.json: damaged report: metrics.average_wasserstein.phases.values[1] is string, expected a number or null");
  EXPECT_EQ(
      refusal("accuracy",
              [](Json& r) {
                r["per_threshold"][0]["floor"] = {{"value", "x"}};
              }),
      "r.json: damaged report: metrics.accuracy.per_threshold[0].floor.value is string, expected a number or null");
}

/// The first is exact; the second is not, and the third has no color.
std::string compared_with_an_exact_one(const ComparisonOptions& options, ComparisonFormat format) {
  std::vector<SavedReport> reports = three_reports();
  const auto fidelity = [&](std::size_t i) -> Json& { return reports[i].json["metrics"]["color_fidelity"]["value"]; };
  fidelity(0) = nullptr;
  reports[0].json["warnings"].push_back({{"id", "color_fidelity_infinite"}, {"message", "every color is exact"}});
  fidelity(1) = 40.0;
  fidelity(2) = nullptr;
  return format_comparison(reports, options, format);
}

TEST(FormatComparison, AnInfiniteFidelityIsBest) {
  const ComparisonOptions against_exact{{"CF"}, 0}, against_other{{"CF"}, 1};
  EXPECT_THAT(compared_with_an_exact_one(against_exact, ComparisonFormat::kText),
              ContainsRegex("color fidelity +CF +↑ +dB +∞\\* +40.00\\+ +-"));
  EXPECT_THAT(compared_with_an_exact_one(against_exact, ComparisonFormat::kText),
              ContainsRegex("color fidelity +CF +↑ +dB +-∞ +-\n"));
  EXPECT_THAT(compared_with_an_exact_one(against_other, ComparisonFormat::kText),
              ContainsRegex("color fidelity +CF +↑ +dB +\\+∞ +-\n"));
  EXPECT_THAT(compared_with_an_exact_one(against_other, ComparisonFormat::kCsv),
              HasSubstr("color_fidelity,,,dB,higher,inf,40,,inf,,,,distinguishable\n"));
  EXPECT_THAT(compared_with_an_exact_one(against_exact, ComparisonFormat::kLatex), HasSubstr("$\\infty$"));
  const std::string page = compared_with_an_exact_one(against_other, ComparisonFormat::kHtml);
  EXPECT_THAT(page, HasSubstr("data-value=\"Infinity\"")) << "as a script reads it";
  EXPECT_THAT(page, HasSubstr(">∞<"));
}

TEST(FormatComparison, TwoInfiniteFidelitiesAreTheSame) {
  std::vector<SavedReport> reports = three_reports();
  for (std::size_t i : {0, 1}) {
    reports[i].json["metrics"]["color_fidelity"]["value"] = nullptr;
    reports[i].json["warnings"].push_back({{"id", "color_fidelity_infinite"}, {"message", "every color is exact"}});
  }
  reports.pop_back();
  const std::string table = format_comparison(reports, {{"CF"}, 0}, ComparisonFormat::kText);
  EXPECT_THAT(table, ContainsRegex("∞\\* +∞\\*"));
  EXPECT_THAT(table, ContainsRegex("color fidelity +CF +↑ +dB +0\n"));
}

TEST(FormatComparison, RecallStandsAboveItsCoverage) {
  const std::string table = compared({{"LCR"}, {}});
  EXPECT_LT(table.find("local color recall"), table.find("coverage (recall of any color)"));
}

TEST(FormatComparison, RefusesMetricsThatAreNotThere) {
  EXPECT_THAT(refusal_of<UsageError>([] { compared({{"nonsense"}, {}}); }), HasSubstr("\"nonsense\" is unknown"));
  EXPECT_THAT(refusal_of<UsageError>([] { compared({{"MME"}, {}}); }), HasSubstr("no report has any of MME"));
}

TEST(FormatComparison, NamesAlignmentsAndVersionsThatDiffer) {
  std::vector<SavedReport> reports = three_reports();
  reports[1].json["alignment"]["method"] = "given";
  reports[2].json["tool"]["version"] = "9.9.9";
  const std::string table = format_comparison(reports, {{"chamfer"}, {}}, ComparisonFormat::kText);
  EXPECT_THAT(table, HasSubstr("alignment: given for b; none for a, c\n"));
  EXPECT_THAT(table, HasSubstr("9.9.9 for c"));
}

TEST(FormatComparison, NamesFilesAndNoFolders) {
  Json report = some_report();
  report["inputs"]["reference"]["path"] = "/home/ann lee/maps/ref.ply";
  for (const auto format :
       {ComparisonFormat::kText, ComparisonFormat::kMarkdown, ComparisonFormat::kLatex, ComparisonFormat::kHtml}) {
    const std::string text = format_comparison({saved("a", report)}, {}, format);
    EXPECT_THAT(text, HasSubstr("reference ref.ply: ")) << static_cast<int>(format);
    EXPECT_THAT(text, Not(HasSubstr("/home"))) << static_cast<int>(format);
  }
}

TEST(FormatComparison, NamesCannotBreakThePage) {
  std::vector<SavedReport> reports = three_reports();
  reports[0].name = "<script>alert(1)</script>";
  const std::string page = format_comparison(reports, {}, ComparisonFormat::kHtml);
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(page, HasSubstr("&lt;script&gt;alert(1)"));
}

}  // namespace comparison_test
}  // namespace cmap

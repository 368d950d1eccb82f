#include "cmap/report/comparison.hpp"

#include "report/report_testing.hpp"

namespace cmap {
namespace {

using test::options_for;
using test::painted_sheet;
using test::refusal_of;
using test::report_of;
using test::small_map;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::ordered_json;

Json some_report() {
  static const Json report = report_of(painted_sheet(400, 1), painted_sheet(300, 2));
  return report;
}

SavedReport saved(const std::string& name, const Json& report) { return {name + ".json", name, report}; }

/// Two reports that differ in what `change` does to the second.
template <class Change>
std::string refusal_for(Change&& change) {
  Json other = some_report();
  change(other);
  return refusal_of<UsageError>([&] { require_comparable({saved("a", some_report()), saved("b", other)}); });
}

TEST(RequireComparable, TakesWhatCompares) {
  EXPECT_EQ(refusal_for([](Json&) {}), "");
  EXPECT_EQ(refusal_for([](Json& r) { r["parameters"]["metrics"] = {"color"}; }), "") << "chosen, not changed";
  EXPECT_EQ(refusal_for([](Json& r) { r["parameters"]["lcr-curve"] = true; }), "");
  EXPECT_EQ(refusal_for([](Json& r) { r["metrics"].erase("chamfer"); }), "");
}

TEST(RequireComparable, RefusesOtherParameters) {
  EXPECT_EQ(
      refusal_for([](Json& r) {
        r["parameters"]["lcr-tau"] = 0.2;
        r["parameters"]["voxel"] = 0.05;
      }),
      "a.json and b.json have different parameters: lcr-tau is 0.1 and 0.2; voxel is null and 0.05; evaluate both "
      "maps with the same ones");
  EXPECT_THAT(refusal_for([](Json& r) { r["parameters"]["new-one"] = 1; }), HasSubstr("new-one is missing and 1"));
}

TEST(RequireComparable, RefusesAnotherReference) {
  const std::string message = refusal_for([](Json& r) { r["inputs"]["reference"]["sha256"] = std::string(64, 'b'); });
  EXPECT_THAT(message, HasSubstr("a.json and b.json have different references: ref.ply (SHA-256 aaaaaaaaaaaa...) and"));
  EXPECT_THAT(message, HasSubstr("cmap_leaderboard"));
}

TEST(RequireComparable, RefusesOtherDefinitions) {
  EXPECT_THAT(refusal_for([](Json& r) { r["metrics"]["chamfer"]["unit"] = "mm"; }),
              HasSubstr("a.json and b.json define chamfer differently: unit is \"m\" and \"mm\""));
  EXPECT_THAT(refusal_for([](Json& r) { r["metrics"]["overlap"]["better"] = "lower"; }), HasSubstr("define overlap"));
  EXPECT_THAT(refusal_for([](Json& r) { r["metrics"]["accuracy"]["per_threshold"].erase(1); }),
              HasSubstr("define accuracy differently: levels is"));
}

TEST(RequireComparable, AMapWithoutColorComparesWithOneThatHasIt) {
  EXPECT_EQ(refusal_for([](Json& r) {
              r["metrics"]["color_distance"] = {{"value", nullptr},
                                                {"unit", "unit RGB"},
                                                {"better", "lower"},
                                                {"symbol", "CD"},
                                                {"parameters", Json::object()}};
            }),
            "");
}

TEST(CheckReport, NamesThePlaceOfTheDamage) {
  const auto refusal = [](auto&& change) {
    Json report = some_report();
    change(report);
    return refusal_of<InputError>([&] { check_report(report, "r.json"); });
  };
  EXPECT_EQ(refusal([](Json&) {}), "");
  EXPECT_EQ(refusal([](Json& r) { r.erase("inputs"); }), "r.json: damaged report: it has no \"inputs\"");
  EXPECT_EQ(refusal([](Json& r) { r["inputs"]["reference"]["sha256"] = 5; }),
            "r.json: damaged report: inputs.reference.sha256 is number, expected text");
  EXPECT_EQ(refusal([](Json& r) { r["metrics"]["accuracy"]["per_threshold"][1]["value"] = "0.1"; }),
            "r.json: damaged report: metrics.accuracy.per_threshold[1].value is string, expected a number or null");
  EXPECT_EQ(refusal([](Json& r) { r["metrics"]["chamfer"].erase("value"); }),
            "r.json: damaged report: metrics.chamfer has no \"value\"");
  EXPECT_EQ(refusal([](Json& r) { r["metrics"] = Json::array(); }),
            "r.json: damaged report: metrics is array, expected an object");
}

TEST(CheckReport, RefusesWhatIsNoReport) {
  const auto refusal = [](const Json& json) { return refusal_of<UsageError>([&] { check_report(json, "r.json"); }); };
  EXPECT_EQ(refusal(Json::parse("[1]")),
            "r.json: is no report of cmap_eval: its schema is missing, expected \"cmap.report/1\"");
  EXPECT_EQ(refusal({{"schema", "cmap.report/2"}}),
            "r.json: is no report of cmap_eval: its schema is \"cmap.report/2\", expected \"cmap.report/1\"");
}

std::vector<std::string> names_for(const std::vector<std::string>& paths, const std::vector<std::string>& names = {}) {
  std::vector<SavedReport> reports;
  for (const std::string& path : paths) reports.push_back({path, "", nullptr});
  name_reports(reports, names);
  std::vector<std::string> given;
  for (const SavedReport& report : reports) given.push_back(report.name);
  return given;
}

TEST(NameReports, TakesTheShortestEndsThatDiffer) {
  using ::testing::ElementsAre;
  EXPECT_THAT(names_for({"/x/a.json", "/y/b.json"}), ElementsAre("a", "b"));
  EXPECT_THAT(names_for({"/x/r.json", "/y/r.json"}), ElementsAre("x/r", "y/r"));
  EXPECT_THAT(names_for({"/m/x/r.json", "/n/x/r.json"}), ElementsAre("m/x/r", "n/x/r"));
  EXPECT_THAT(names_for({"/x/a.json", "/y/b.json"}, {"Ours", "Theirs"}), ElementsAre("Ours", "Theirs"));
}

TEST(NameReports, RefusesNamesThatDoNotTellApart) {
  const auto refusal = [](const std::vector<std::string>& paths, const std::vector<std::string>& names) {
    return refusal_of<UsageError>([&] { names_for(paths, names); });
  };
  EXPECT_EQ(refusal({"/x/a.json", "/x/../x/a.json"}, {}), "/x/../x/a.json: is given twice");
  EXPECT_EQ(refusal({"/x/a.json", "/y/b.json"}, {"one"}), "names: 1 for 2 reports");
  EXPECT_EQ(refusal({"/x/a.json", "/y/b.json"}, {"one", "one"}), "names: \"one\" is given twice");
  EXPECT_EQ(refusal({"/x/a.json", "/y/b.json"}, {"one", ""}), "/y/b.json: its name is empty");
}

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
  const std::string table = compared({{"chamfer", "overlap"}, {}});
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
            "relative\"\n"
            "chamfer,,,m,lower,2,1,,1,0.5,,\n"
            "overlap,,,1,higher,0.5,0.5,0.25,0,0,-0.25,-0.5\n");
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

TEST(FormatComparison, NamesCannotBreakThePage) {
  std::vector<SavedReport> reports = three_reports();
  reports[0].name = "<script>alert(1)</script>";
  const std::string page = format_comparison(reports, {}, ComparisonFormat::kHtml);
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(page, HasSubstr("&lt;script&gt;alert(1)"));
}

}  // namespace
}  // namespace cmap

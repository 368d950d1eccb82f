#include "board/comparison_testing.hpp"

namespace cmap {
namespace comparable_test {

using test::options_for;
using test::painted_sheet;
using test::refusal_of;
using test::report_of;
using test::saved;
using test::some_report;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::ordered_json;

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

/// A report as cmap 0.1.0 wrote it, before it is completed: the given color consistency, in voxels of that edge.
Json earlier_report(double ccs_voxel_m = 0.2) {
  Json report = some_report();
  report["schema"] = "cmap.report/1";
  report["tool"]["version"] = "0.1.0";
  report["parameters"].erase("ccs-singletons");
  report["parameters"]["ccs-voxel"] = ccs_voxel_m;
  report["metrics"]["color_consistency"]["parameters"] = {{"voxel_m", ccs_voxel_m}, {"min_points", 2}};
  return report;
}

/// Read from a file, as it would be.
SavedReport read_back(const std::string& name, const Json& report) {
  const testing::TempFolder folder;
  SavedReport saved_report = read_report(folder.write(name + ".json", report.dump()));
  saved_report.name = name;
  saved_report.path = name + ".json";
  return saved_report;
}

/// A report of today whose color consistency is in voxels of that edge.
Json report_with(double ccs_voxel_m, const char* singletons) {
  Json report = some_report();
  report["parameters"]["ccs-voxel"] = ccs_voxel_m;
  report["parameters"]["ccs-singletons"] = singletons;
  report["metrics"]["color_consistency"]["parameters"] = {
      {"voxel_m", ccs_voxel_m}, {"singletons", singletons}, {"min_points", 2}};
  return report;
}

TEST(ReadReport, AnEarlierOneSaysWhatItsColorConsistencyWas) {
  const Json report = read_back("a", earlier_report()).json;
  EXPECT_EQ(report.at("schema"), "cmap.report/1");
  EXPECT_EQ(report.at("parameters").at("ccs-singletons"), "exclude");
  EXPECT_EQ(report.at("metrics").at("color_consistency").at("parameters").at("singletons"), "exclude");
  Json bare = earlier_report();
  bare["parameters"].erase("index");  // as an option that came later
  EXPECT_EQ(read_back("a", bare).json.at("parameters").at("index"), "bvh");
}

TEST(RequireComparable, EarlierColorConsistencyComparesOnlyWithItsLike) {
  const SavedReport earlier = read_back("a", earlier_report());
  const auto refusal = [&](const Json& now, const ComparisonOptions& options) {
    return refusal_of<UsageError>([&] { require_comparable({earlier, saved("b", now)}, options); });
  };
  EXPECT_EQ(refusal(report_with(0.2, "exclude"), {}), "");
  const std::string message = refusal(report_with(0.1, "zero"), {});
  EXPECT_THAT(message, HasSubstr("ccs-voxel is 0.2 and 0.1"));
  EXPECT_THAT(message, HasSubstr("ccs-singletons is \"exclude\" and \"zero\""));
  EXPECT_THAT(message, HasSubstr("versions 0.1.0 and"));
  EXPECT_THAT(message, HasSubstr("--metrics"));
  EXPECT_EQ(refusal(report_with(0.1, "zero"), {{"geometry"}, {}}), "") << "left out";
  EXPECT_THAT(refusal(report_with(0.1, "zero"), {{"chamfer", "CCS"}, {}}), HasSubstr("ccs-voxel"));
}

TEST(RequireComparable, RefusesEntropiesFromBeforeAndSince) {
  Json earlier = report_of(painted_sheet(400, 1), painted_sheet(300, 2), options_for({"mme", "chamfer"}));
  const Json now = earlier;
  earlier["schema"] = "cmap.report/1";
  earlier["tool"]["version"] = "0.1.0";
  const std::vector<SavedReport> reports{read_back("a", earlier), saved("b", now)};
  EXPECT_THAT(
      refusal_of<UsageError>([&] { require_comparable(reports); }),
      HasSubstr("a.json and b.json define mean_map_entropy differently: before, points in neighborhoods that are "
                "flat to rounding counted; they come from versions 0.1.0 and "));
  EXPECT_EQ(refusal_of<UsageError>([&] { require_comparable(reports, {{"chamfer"}, {}}); }), "");
  EXPECT_EQ(refusal_of<UsageError>([&] { require_comparable({reports[0], reports[0]}); }), "") << "both from before";
}

TEST(VersionNotes, SayWhatMayDiffer) {
  const std::vector<SavedReport> reports{read_back("a", earlier_report()), saved("b", report_with(0.2, "exclude"))};
  EXPECT_TRUE(version_notes({reports[0], reports[0]}, {}).empty());
  const std::string version = some_report()["tool"]["version"];
  const std::string first =
      "version of cmap: 0.1.0 for a; " + version + " for b; what changed between them is in CHANGELOG.md";
  EXPECT_THAT(version_notes(reports, {{"chamfer"}, {}}), ::testing::ElementsAre(first));
  EXPECT_THAT(version_notes(reports, {{"fitness", "overlap"}, {}}),
              ::testing::ElementsAre(first,
                                     "in the earlier version a distance within rounding of the threshold did not count "
                                     "as at it: fitness, overlap"));
  const std::string table = format_comparison(reports, {{"fitness"}, {}}, ComparisonFormat::kText);
  for (const std::string& note : version_notes(reports, {{"fitness"}, {}})) EXPECT_THAT(table, HasSubstr(note));
}

TEST(RequireComparable, OnlyWhatBearsOnTheMetricsCounts) {
  Json other = some_report();
  other["parameters"]["lcr-radius"] = 0.1;
  other["metrics"]["local_color_recall"]["parameters"]["radius_m"] = 0.1;
  const auto refusal = [&](const ComparisonOptions& options) {
    return refusal_of<UsageError>([&] { require_comparable({saved("a", some_report()), saved("b", other)}, options); });
  };
  EXPECT_THAT(refusal({}), HasSubstr("lcr-radius is 0.5 and 0.1"));
  EXPECT_THAT(refusal({{"LCR"}, {}}), HasSubstr("lcr-radius"));
  EXPECT_EQ(refusal({{"chamfer", "CCS"}, {}}), "");
  other["parameters"]["voxel"] = 0.1;
  EXPECT_THAT(refusal({{"chamfer"}, {}}), HasSubstr("voxel is null and 0.1")) << "bears on all";
}

TEST(OneMap, ComparesWithItsLike) {
  EvaluationOptions options;
  options.ccs_voxel_m = 1.0;  // in which several points lie
  const SavedReport a = read_back("a", test::map_report_of(painted_sheet(400, 1), options));
  const SavedReport b = read_back("b", test::map_report_of(painted_sheet(300, 2), options));
  require_comparable({a, b});
  const std::string table = format_comparison({a, b}, {}, ComparisonFormat::kText);
  EXPECT_THAT(table, ContainsRegex("color consistency +CCS +↓ +unit RGB\\^2 +[0-9.]+. +[0-9.]+."));
  EXPECT_THAT(table, HasSubstr("not tested (no interval of the difference)")) << "no --bootstrap would help";
  EXPECT_THAT(table, ContainsRegex("point spacing +m +[0-9.]+ +[0-9.]+\n")) << "neither is better";
  EXPECT_THAT(table, Not(HasSubstr("SHA-256")));
  EXPECT_EQ(refusal_of<UsageError>([&] {
              require_comparable({a, saved("pair", some_report())});
            }),
            "pair.json is about a map and its reference and a.json about a map alone: they do not compare");
}

TEST(CheckReport, OfOneMap) {
  Json report = test::map_report_of(painted_sheet(400, 1));
  EXPECT_EQ(refusal_of<InputError>([&] { check_report(report, "r.json"); }), "");
  report["alignment"] = Json::object();
  EXPECT_EQ(refusal_of<InputError>([&] { check_report(report, "r.json"); }),
            "r.json: damaged report: alignment is object, expected null");
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
  EXPECT_EQ(refusal([](Json& r) { r["intervals"] = nullptr; }),
            "r.json: damaged report: intervals is null, expected an object");
  EXPECT_EQ(refusal([](Json& r) {
              r["intervals"] = {{"replicates", 10u}, {"seed", 1u}, {"level", "0.95"}, {"blocks", Json::object()}};
            }),
            "r.json: damaged report: intervals.level is string, expected a number");
}

TEST(CheckReport, RefusesWhatIsNoReport) {
  const auto refusal = [](const Json& json) { return refusal_of<UsageError>([&] { check_report(json, "r.json"); }); };
  EXPECT_EQ(refusal(Json::parse("[1]")),
            "r.json: is no report of cmap_eval: its schema is missing, expected \"cmap.report/2\" or an earlier one");
  EXPECT_EQ(refusal({{"schema", "cmap.report/3"}}),
            "r.json: is no report of cmap_eval: its schema is \"cmap.report/3\", expected \"cmap.report/2\" or an "
            "earlier one");
  EXPECT_THAT(refusal({{"schema", 2}}), HasSubstr("its schema is 2"));
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

}  // namespace comparable_test
}  // namespace cmap

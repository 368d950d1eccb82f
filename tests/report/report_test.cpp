#include "cmap/report/report.hpp"

#include <bit>
#include <cmath>
#include <functional>

#include "cmap/core/version.hpp"
#include "cmap/report/parameters.hpp"
#include "io/io_testing.hpp"
#include "report/report_testing.hpp"

namespace cmap {
namespace report_test {

using Json = nlohmann::ordered_json;
using test::described;
using test::gray_map;
using test::options_for;
using test::painted_sheet;
using test::report_of;
using test::small_map;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const PointCloud kReference = gray_map({{0, 0, 0}, {2, 0, 0}});
const PointCloud kEstimate = gray_map({{0, 0, 0.5f}, {2, 0.5f, 0}});

std::vector<std::string> keys(const Json& object) {
  std::vector<std::string> result;
  for (const auto& [key, value] : object.items()) result.push_back(key);
  return result;
}

Json parsed(const char* json) { return Json::parse(json); }

TEST(Report, HasEverySectionInOrder) {
  const Json report = report_of(kReference, kEstimate);
  EXPECT_THAT(keys(report),
              ElementsAre("schema", "tool", "inputs", "parameters", "alignment", "metrics", "warnings", "run"));
  EXPECT_EQ(report.at("schema"), "cmap.report/2");
  EXPECT_EQ(report.at("tool"), Json({{"name", "cmap_eval"}, {"version", kVersion}}));
}

TEST(Report, DescribesItsInputs) {
  PointCloud reference = kReference;
  reference.origin = {500000, 4000000, 100};
  const Json input = report_of(reference, kEstimate).at("inputs").at("reference");
  EXPECT_EQ(input,
            parsed(R"({"path": "ref.ply", "sha256": "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa",
      "format": "PLY ascii", "points": 2, "finite_points": 2, "left_out": {}, "color": "u8", "color_scale": null,
      "origin_m": [500000.0, 4000000.0, 100.0],
      "bounds_m": {"min": [500000.0, 4000000.0, 100.0], "max": [500002.0, 4000000.0, 100.0]}})"));
}

TEST(Report, NamesTheStorageOfColors) {
  PointCloud map = small_map({{0, 0, 0}});
  EXPECT_EQ(described("a", map).color, "none");
  map.colors = Array<Rgb8>(1);
  EXPECT_EQ(described("a", map).color, "u8");
  map.colors = Array<Rgb16>(1);
  EXPECT_EQ(described("a", map).color, "u16");
  map.colors = Array<RgbF>(1);
  EXPECT_EQ(described("a", map).color, "f32");
}

TEST(Report, DescribesAFileAsItWasRead) {
  const testing::TempFolder folder;
  const auto path = folder.write("a.xyz", "1 2 3\n4 5 nan\n7 8 9\n");
  const InputDescription input = describe(read_point_cloud(path, {.sha256 = true}));
  EXPECT_EQ(input.file.points, 3U);
  EXPECT_EQ(input.file.finite_points, 2U);
  EXPECT_EQ(input.bounds_m.max, Eigen::Vector3d(7, 8, 9));
  EXPECT_EQ(input.file.sha256, "1022f20ed58e6129e01b88aa3b24a4de95cd13e338643fe77b8603f6a251b36b");
}

TEST(Report, HoldsEveryParameterByTheCommandLinesName) {
  EvaluationOptions options;
  options.lcr_radius_m = 0.25;
  EXPECT_EQ(report_of(kReference, kEstimate, options).at("parameters"), to_json(options));
}

TEST(Report, SaysThatNothingWasAligned) {
  EXPECT_EQ(
      report_of(kReference, kEstimate).at("alignment"),
      parsed(
          R"({"method": "none", "T_ref_est": [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]],
                       "scale": 1.0, "scale_error": 0.0, "before": null, "overlap": 1.0, "rmse_m": 0.5, "registration": null})"));
}

TEST(Report, HoldsTheTransformThatWasGiven) {
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T.topLeftCorner<3, 3>() *= 0.5;
  T(0, 3) = 0.1;
  const Json alignment = report_of(kReference, kEstimate, {}, T).at("alignment");
  EXPECT_EQ(alignment.at("method"), "given");
  EXPECT_NEAR(alignment.at("scale"), 0.5, 1e-15);
  EXPECT_EQ(alignment.at("T_ref_est"),
            parsed("[[0.5, 0.0, 0.0, 0.1], [0.0, 0.5, 0.0, 0.0], [0.0, 0.0, 0.5, 0.0], [0.0, 0.0, 0.0, 1.0]]"));
}

TEST(Report, EveryMetricCarriesUnitDirectionSymbolAndParameters) {
  const Json metrics = report_of(kReference, kEstimate, options_for({"all"})).at("metrics");
  EXPECT_EQ(metrics.size(), metric_list().size());
  for (const Metric* metric : metric_list()) {
    const MetricInfo& info = metric->info;
    SCOPED_TRACE(info.id);
    const Json& record = metrics.at(std::string(info.id));
    EXPECT_EQ(record.at("unit"), info.unit);
    EXPECT_EQ(record.at("better"), info.better.empty() ? Json(nullptr) : Json(info.better));
    EXPECT_EQ(record.at("symbol"), info.symbol);
    EXPECT_TRUE(record.at("parameters").is_object());
    EXPECT_EQ(record.contains("per_threshold"), info.per_threshold);
  }
}

TEST(Report, OfOneMapHasNoReferenceAndNoAlignment) {
  const Json report = test::map_report_of(kReference);
  EXPECT_THAT(keys(report),
              ElementsAre("schema", "tool", "inputs", "parameters", "alignment", "metrics", "warnings", "run"));
  EXPECT_THAT(keys(report.at("inputs")), ElementsAre("estimate"));
  EXPECT_EQ(report.at("inputs").at("estimate").at("path"), "map.ply");
  EXPECT_TRUE(report.at("alignment").is_null());
  EXPECT_THAT(keys(report.at("metrics")), ElementsAre("color_consistency", "mean_map_entropy", "point_spacing"));
  EXPECT_FALSE(report.at("metrics").at("color_consistency").contains("reference"));
  EXPECT_EQ(report.at("metrics").at("point_spacing"),
            parsed(R"({"value": 2.0, "mean": 2.0, "n": 2, "n_copies": 0, "unit": "m", "better": null, "symbol": "",
                       "parameters": {}})"));
}

TEST(Report, HasAliasesOnlyWhereAskedFor) {
  EvaluationOptions options = options_for({"chamfer"});
  options.as = test::tools({"open3d"});
  EXPECT_THAT(keys(report_of(kReference, kEstimate, options).at("aliases")), ElementsAre("open3d"));
  EXPECT_FALSE(report_of(kReference, kEstimate).contains("aliases"));
}

TEST(Report, WarnsOfGrayBesideColor) {
  InputDescription gray = described("est.ply", kEstimate);
  gray.file.gray_colors = true;
  const auto ids = [&](const InputDescription& reference, const InputDescription& estimate) {
    const Json report =
        make_report(reference, estimate, evaluate(kReference, kEstimate, options_for({"chamfer"})), test::a_run());
    std::string all;
    for (const Json& warning : report.at("warnings")) all += warning.at("id").get<std::string>() + " ";
    return all;
  };
  const InputDescription colored = described("ref.ply", kReference);
  EXPECT_NE(ids(colored, gray).find("gray_colors"), std::string::npos);
  EXPECT_NE(ids(gray, colored).find("gray_colors"), std::string::npos);
  EXPECT_EQ(ids(gray, gray).find("gray_colors"), std::string::npos);
  EXPECT_EQ(ids(colored, colored).find("gray_colors"), std::string::npos);
}

TEST(Report, WarnsOfWhatReadersDecided) {
  InputDescription reference = described("ref.ply", kReference);
  reference.file.points = 5;
  reference.file.notes = {"8-bit colors in 16-bit fields"};
  const Json warnings = make_report(reference, described("est.ply", kEstimate),
                                    evaluate(kReference, kEstimate, options_for({"chamfer"})), test::a_run())
                            .at("warnings");
  EXPECT_EQ(warnings, parsed(R"([{"id": "non_finite_points_dropped",
                                  "message": "reference: 3 of 5 points are not finite and were dropped"},
                                 {"id": "input_note", "message": "reference: 8-bit colors in 16-bit fields"}])"));
}

TEST(Report, WarningsOfTheEvaluationFollow) {
  const Json warnings =
      report_of(kReference, gray_map({{50, 0, 0}, {51, 0, 0}}), options_for({"chamfer"})).at("warnings");
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_EQ(warnings[0].at("id"), "units_or_frame_mismatch");
  EXPECT_EQ(warnings[1].at("id"), "no_overlap");
  EXPECT_EQ(report_of(kReference, kEstimate, options_for({"chamfer"})).at("warnings"), Json::array())
      << "an empty list, never absent";
}

TEST(Report, DescribesTheRun) {
  Json run = report_of(kReference, kEstimate).at("run");
  EXPECT_GT(run.at("peak_memory_bytes"), 1000000);
  run.erase("peak_memory_bytes");
  EXPECT_EQ(run,
            parsed(R"({"command": "cmap_eval ref.ply est.ply", "started_utc": "2024-05-06T07:08:09Z", "wall_s": 1.5,
                            "stages": {"read": 0.5, "index": 1.0}, "threads": 2, "simd": "avx2"})"));
}

/// The bits of all numbers of a report, so that equal means equal.
std::vector<std::uint64_t> bits_of_numbers(const Json& value) {
  std::vector<std::uint64_t> bits;
  const std::function<void(const Json&)> collect = [&](const Json& item) {
    if (item.is_number()) {
      bits.push_back(std::bit_cast<std::uint64_t>(item.get<double>()));
    } else if (item.is_structured()) {
      for (const Json& child : item) collect(child);
    }
  };
  collect(value);
  return bits;
}

TEST(Report, NumbersSurviveTheirText) {
  EvaluationOptions options = options_for({"all"});
  options.as = test::tools({"color-map-evaluation", "cloudanalyzer", "mapeval", "open3d", "mpeg", "cloudcompare"});
  options.lcr_curve = true;
  options.lcr_radius_m = std::nextafter(0.5, 1.0);
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T(0, 3) = 1e-17;
  T(1, 3) = 1.0 / 3.0;
  const Json report = report_of(painted_sheet(3000, 1), painted_sheet(2000, 2), options, T);
  for (int indent : {-1, 2}) {
    const Json again = Json::parse(report.dump(indent));
    EXPECT_EQ(bits_of_numbers(again), bits_of_numbers(report));
    EXPECT_EQ(again, report);
  }
  EXPECT_GT(bits_of_numbers(report).size(), 200U);
}

TEST(Report, MissingNumbersAreNull) {
  const Json report = report_of(small_map({{0, 0, 0}}), small_map({{100, 0, 0}}), options_for({"all"}));
  const Json metrics = report.at("metrics");
  for (const char* id :
       {"color_distance", "color_psnr", "color_consistency", "average_wasserstein", "mean_map_entropy"}) {
    EXPECT_TRUE(metrics.at(id).at("value").is_null()) << id;
  }
  EXPECT_TRUE(metrics.at("rmse").at("inlier_rmse").is_null());
  EXPECT_EQ(report.dump().find("NaN"), std::string::npos);
}

TEST(Report, PathsInAnyEncodingMakeAReport) {
  const Json report = make_report(described("caf\xe9.ply", kReference), described("est.ply", kEstimate),
                                  evaluate(kReference, kEstimate, options_for({"chamfer"})), test::a_run());
  EXPECT_NO_THROW(static_cast<void>(report.dump()));
}

}  // namespace report_test
}  // namespace cmap

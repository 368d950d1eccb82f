// Real maps against numbers from other programs: an independent implementation of METRICS, and the tools that the
// aliases stand for.

#include <algorithm>
#include <numbers>
#include <optional>

#include "conformance/real_maps.hpp"

namespace cmap::test {
namespace golden_test {

namespace fs = std::filesystem;

/// tum_fr1, evaluated once for all tests.
class TumFr1 : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (!fs::exists(shared_folder() / "data/tum_fr1") || !fs::exists(shared_folder() / "golden/tum_fr1.json")) return;
    Pair pair = read_tum();
    evaluation_.emplace(evaluate(std::move(pair.reference), std::move(pair.estimate), options_of(kTumOptions)));
  }
  static void TearDownTestSuite() { evaluation_.reset(); }
  void SetUp() override {
    if (!evaluation_)
      GTEST_SKIP() << "no real data: " << shared_folder() / "data/tum_fr1"
                   << " or ../golden is missing; set CMAP_SHARED_DIR";
  }
  static Json fields(const std::string& metric) { return fields_of(*evaluation_, metric); }

  static inline std::optional<EvaluatedPair> evaluation_;
};

/// The number of a report that a key of golden/tum_fr1.json stands for: "cd", "fitness@0.05".
Json golden_number(const EvaluatedPair& evaluation, const std::string& key) {
  static const std::map<std::string, std::pair<std::string, std::string>> kPlaces{
      {"chamfer_l1_sum", {"chamfer", "/value"}},
      {"chamfer_l1_mean", {"chamfer", "/variants/l1_mean"}},
      {"chamfer_l2sq_sum", {"chamfer", "/variants/l2sq_sum"}},
      {"hausdorff", {"hausdorff", "/value"}},
      {"overlap", {"overlap", "/value"}},
      {"accuracy_rmse", {"accuracy", "/value"}},
      {"fitness", {"fitness", "/value"}},
      {"completeness", {"completeness", "/value"}},
      {"fscore", {"f_score", "/value"}},
      {"awd", {"average_wasserstein", "/value"}},
      {"awd_voxels", {"average_wasserstein", "/n_voxels"}},
      {"scs", {"spatial_consistency", "/value"}},
      {"cd", {"color_distance", "/value"}},
      {"cd_8bit", {"color_distance", "/value_8bit"}},
      {"cf_db", {"color_fidelity", "/value"}},
      {"lcr", {"local_color_recall", "/value"}},
      {"lcr_coverage", {"local_color_recall", "/coverage"}},
      {"ccs", {"color_consistency", "/value"}},
      {"ccs_voxels", {"color_consistency", "/n_voxels"}}};
  const std::size_t at = key.find('@');
  const auto& [metric, path] = kPlaces.at(key.substr(0, at));
  const Json record = fields_of(evaluation, metric);
  if (at == std::string::npos) return record.at(Json::json_pointer(path));
  for (const Json& entry : record.at("per_threshold")) {
    if (entry.at("threshold_m") == std::stod(key.substr(at + 1))) return entry.at(Json::json_pointer(path));
  }
  throw std::out_of_range("no threshold of " + key);
}

TEST_F(TumFr1, EveryNumberOfTheIndependentImplementation) {
  const Json golden = test::read_json(shared_folder() / "golden/tum_fr1.json").at("metrics");
  ASSERT_EQ(golden.size(), 35U);
  test::WorstDifferences worst;
  for (const auto& [key, expected] : golden.items()) {
    // Both work in double from the same floats: only the order of sums differs, and which distances within the rounding
    // of the coordinates count as at a threshold.
    const bool at_threshold = key.find('@') != std::string::npos || key == "overlap" || key.starts_with("lcr");
    test::RecordComparison({at_threshold ? 1e-4 : 1e-9, 0.0}, worst)
        .compare(key, expected, golden_number(*evaluation_, key));
  }
  worst.print("tum_fr1.json");
}

/// What the authors' own tool says of every 20th point, at its defaults; ours under other options.
TEST(AuthorsTool, EveryNumberOfItsReport) {
  const fs::path folder = shared_folder() / "golden/color_map_evaluation";
  SKIP_WITHOUT(folder);
  const Json golden = test::read_json(folder / "expected.json");
  EvaluationOptions options = options_of({{"as", {"color-map-evaluation"}}, {"lcr-radius", 0.05}, {"ccs-voxel", 0.3}});
  const auto evaluated = [&] {
    return evaluate(read_point_cloud(folder / "reference.ply").cloud, read_point_cloud(folder / "estimate.ply").cloud,
                    options);
  };
  test::WorstDifferences worst;
  test::RecordComparison comparison({1e-9, 0.0}, worst);
  comparison.compare("alias", golden.at("metrics"), peer_fields(evaluated(), "color-map-evaluation"));
  options = EvaluationOptions{};  // whose definitions are the same
  const EvaluatedPair ours = evaluated();
  comparison.compare("CD", golden.at("metrics").at("CD"), fields_of(ours, "color_distance").at("value"));
  comparison.compare("CF", golden.at("metrics").at("CF_dB"), fields_of(ours, "color_fidelity").at("value"));
  comparison.compare("CCS", golden.at("metrics").at("CCS"), fields_of(ours, "color_consistency").at("value"));
  comparison.compare("CCS", golden.at("CCS_exclude"), fields_of(ours, "color_consistency").at("exclude"));
  worst.print("Color-Map-Evaluation");
}

/// `found` rounded to the digits of `expected`, as printed with so many significant digits.
void expect_printed(double found, double expected, int significant_digits, const std::string& what) {
  const double last_digit = std::pow(10.0, std::floor(std::log10(std::abs(expected))) + 1.0 - significant_digits);
  EXPECT_TRUE(std::abs(found - expected) <= 0.5001 * last_digit)
      << what << ": expected " << expected << ", found " << found;
  std::cout << "  " << what << ' ' << std::abs(found - expected) / std::abs(expected) << '\n';
}

/// The last digits of these depend on the order in which the tool added.
void expect_sum(double found, double expected, const std::string& what) {
  EXPECT_TRUE(std::abs(found - expected) <= 1e-11 * std::abs(expected))
      << what << ": expected " << expected << ", found " << found;
  std::cout << "  " << what << ' ' << std::abs(found - expected) / std::abs(expected) << '\n';
}

Json peers() { return test::read_json(shared_folder() / "golden/peers_tum_fr1.json"); }

TEST_F(TumFr1, WhatMapEvalPrints) {
  const Json golden = peers().at("mapeval");
  const Json found = peer_fields(*evaluation_, "mapeval");
  ASSERT_EQ(golden.at("AC").size(), found.at("per_threshold").size());
  for (std::size_t t = 0; t < golden.at("AC").size(); ++t) {
    const Json& level = found.at("per_threshold")[t];
    ASSERT_EQ(level.at("threshold_m"), golden.at("thresholds_m")[t]);
    expect_sum(level.at("AC"), golden.at("AC")[t], "mapeval AC");
    expect_printed(level.at("COM"), golden.at("COM")[t], 15, "mapeval COM");
  }
  EXPECT_EQ(found.at("n_voxels"), 183);
  expect_printed(found.at("AWD"), golden.at("AWD"), 6, "mapeval AWD");
  expect_printed(found.at("SCS"), golden.at("SCS"), 6, "mapeval SCS");
  for (const char* map : {"estimate", "reference"}) {
    expect_printed(found.at("MME").at(map), golden.at("MME").at(map), 6, std::string("mapeval MME ") + map);
    const std::string valid = std::string("valid_") + map;
    EXPECT_EQ(found.at("MME").at(valid), golden.at("MME").at(valid));
  }
}

TEST_F(TumFr1, WhatOpen3dReturns) {
  const Json golden = peers().at("open3d");
  const Json found = peer_fields(*evaluation_, "open3d");
  for (const Json& expected : golden.at("at")) {
    const auto level = std::find_if(found.at("per_threshold").begin(), found.at("per_threshold").end(),
                                    [&](const Json& l) { return l.at("threshold_m") == expected.at("threshold_m"); });
    ASSERT_NE(level, found.at("per_threshold").end());
    EXPECT_EQ(level->at("fitness"), expected.at("fitness"));
    EXPECT_EQ(level->at("correspondences"), expected.at("correspondences"));
    expect_sum(level->at("inlier_rmse"), expected.at("inlier_rmse"), "open3d inlier_rmse");
  }
  for (const char* direction : {"estimate_to_reference", "reference_to_estimate"}) {
    expect_sum(found.at("mean_distance").at(direction), golden.at("mean_distance").at(direction),
               "open3d mean distance");
  }
}

TEST_F(TumFr1, WhatCloudCompareLogs) {
  const Json golden = peers().at("cloudcompare");
  const Json found = peer_fields(*evaluation_, "cloudcompare");
  expect_printed(found.at("mean"), golden.at("mean"), 5, "cloudcompare mean");  // six decimals
  expect_printed(found.at("std"), golden.at("std"), 5, "cloudcompare std");
}

TEST_F(TumFr1, WhatPcErrorPrints) {
  const Json golden = peers().at("mpeg_pc_error");
  const Json found = peer_fields(*evaluation_, "mpeg");
  constexpr int kDigits = 9;
  for (const char* direction : {"reference_to_estimate", "estimate_to_reference"}) {
    const Json& ours = found.at(direction);
    expect_printed(ours.at("point_mse"), golden.at("p2point_mse").at(direction), kDigits, "mpeg p2point");
    expect_printed(ours.at("hausdorff_squared"), golden.at("hausdorff_squared").at(direction), kDigits,
                   "mpeg hausdorff");
    for (std::size_t c = 0; c < 3; ++c) {
      expect_printed(ours.at("color_mse")[c], golden.at("color_mse").at(direction)[c], kDigits, "mpeg color mse");
    }
  }
  for (std::size_t c = 0; c < 3; ++c) {
    expect_printed(found.at("symmetric").at("color_psnr")[c], golden.at("color_psnr_symmetric")[c], kDigits,
                   "mpeg psnr");
  }
}

/// Pairs whose neighbor differs; in all of them both must be equally near.
std::size_t count_ties(const NearestField& ours, const NearestField& other) {
  std::size_t n_ties = 0;
  for (std::size_t i = 0; i < ours.slot.size(); ++i) {
    // The same three squares, perhaps added in another order.
    EXPECT_NEAR(ours.sq_dist[i], other.sq_dist[i], 1e-15 * ours.sq_dist[i]);
    n_ties += ours.slot[i] != other.slot[i] ? 1 : 0;
  }
  return n_ties;
}

TEST_F(TumFr1, FlannAgreesExceptOnTies) {
  Json config = kTumOptions;
  config["index"] = "flann";
  config["as"] = Json::array();
  Pair pair = read_tum();
  const EvaluatedPair flann = evaluate(std::move(pair.reference), std::move(pair.estimate), options_of(config));
  const std::size_t n_ties = count_ties(evaluation_->pair.nearest_in_reference, flann.pair.nearest_in_reference) +
                             count_ties(evaluation_->pair.nearest_in_estimate, flann.pair.nearest_in_estimate);
  std::cout << "  " << n_ties << " ties\n";
  test::WorstDifferences worst;
  for (const MetricRecord& metric : evaluation_->metrics) {
    const std::string id(metric.info->id);
    if (id == "color_distance" || id == "color_fidelity") continue;
    test::RecordComparison({1e-9, 0.0}, worst).compare(id, record_json(metric.record), fields_of(flann, id));
  }
  worst.print("FLANN");
  // A tie changes one term of one mean by sqrt 3 at most.
  const double n_points = fields("color_distance").at("n_estimate");
  EXPECT_NEAR(fields_of(flann, "color_distance").at("value"), fields("color_distance").at("value").get<double>(),
              1e-12 + static_cast<double>(n_ties) * std::numbers::sqrt3 / n_points);
}

}  // namespace golden_test
}  // namespace cmap::test

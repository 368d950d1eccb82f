// Real maps against numbers from other programs: an independent implementation of METRICS, and the tools that the
// aliases stand for. The data lie outside the repository: $CMAP_SHARED_DIR, or ../shared beside it.

#include <Eigen/Geometry>
#include <array>
#include <cstring>
#include <numbers>
#include <optional>
#include <random>

#include "cmap/io/point_cloud_file.hpp"
#include "conformance/records.hpp"
#include "io/io_testing.hpp"
#include "spatial/clouds.hpp"

namespace cmap {
namespace {

namespace fs = std::filesystem;
using test::Json;

fs::path shared_folder() {
  if (const char* folder = std::getenv("CMAP_SHARED_DIR")) return folder;
  return test::source_folder() / "../shared";
}

#define SKIP_WITHOUT(path) \
  if (!fs::exists(path)) GTEST_SKIP() << "no real data: " << (path) << " is missing; set CMAP_SHARED_DIR"

EvaluationOptions options_of(const Json& config) {
  EvaluationOptions options;
  apply_config(options, config.dump(), "golden test");
  return options;
}

struct Pair {
  PointCloud reference;
  PointCloud estimate;
};

const Json kTumOptions{{"metrics", {"color", "geometry", "distribution"}},
                       {"thresholds", {0.2, 0.1, 0.05, 0.02, 0.01}},
                       {"overlap-distance", 0.2},
                       {"lcr-radius", 0.05},
                       {"ccs-voxel", 0.05},
                       {"awd-voxel", 0.5},
                       {"mme-radius", 0.05},
                       {"as", {"mapeval", "open3d", "cloudcompare", "mpeg"}}};

Pair read_tum() {
  const fs::path folder = shared_folder() / "data/tum_fr1";
  return {read_point_cloud(folder / "reference.ply").cloud, read_point_cloud(folder / "estimate.ply").cloud};
}

/// tum_fr1, evaluated once for all tests.
class TumFr1 : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (!fs::exists(shared_folder() / "data/tum_fr1") || !fs::exists(shared_folder() / "golden/tum_fr1.json")) return;
    Pair pair = read_tum();
    evaluation_.emplace(evaluate(std::move(pair.reference), std::move(pair.estimate), options_of(kTumOptions)));
  }
  static void TearDownTestSuite() { evaluation_.reset(); }
  void SetUp() override {
    if (!evaluation_) GTEST_SKIP() << "no real data: " << shared_folder() / "data/tum_fr1" << " or ../golden is missing; set CMAP_SHARED_DIR";
  }
  static const Json& fields(const std::string& metric) { return evaluation_->find(metric)->fields; }

  static inline std::optional<Evaluation> evaluation_;
};

/// The number of a report that a key of golden/tum_fr1.json stands for: "cd", "fitness@0.05".
const Json& golden_number(const Evaluation& evaluation, const std::string& key) {
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
  const Json& record = evaluation.find(metric)->fields;
  if (at == std::string::npos) return record.at(Json::json_pointer(path));
  for (const Json& entry : record.at("per_threshold")) {
    if (entry.at("threshold_m") == std::stod(key.substr(at + 1))) return entry.at(Json::json_pointer(path));
  }
  throw std::out_of_range("no threshold of " + key);
}

TEST_F(TumFr1, EveryNumberOfTheIndependentImplementation) {
  const Json golden = test::read_json(shared_folder() / "golden/tum_fr1.json").at("metrics");
  ASSERT_EQ(golden.size(), 36U);
  test::WorstDifferences worst;
  // What METRICS asks of an implementation.
  test::RecordComparison comparison({1e-5, 0.0}, worst);
  for (const auto& [key, expected] : golden.items()) {
    comparison.compare(key, expected, golden_number(*evaluation_, key));
  }
  worst.print("tum_fr1.json");
}

/// `found` rounded to the digits of `expected`, as printed with so many significant digits.
void expect_printed(double found, double expected, int significant_digits, const std::string& what) {
  const double last_digit = std::pow(10.0, std::floor(std::log10(std::abs(expected))) + 1.0 - significant_digits);
  EXPECT_TRUE(std::abs(found - expected) <= 0.5001 * last_digit) << what << ": expected " << expected << ", found " << found;
  std::cout << "  " << what << ' ' << std::abs(found - expected) / std::abs(expected) << '\n';
}

/// The last digits of these depend on the order in which the tool added.
void expect_sum(double found, double expected, const std::string& what) {
  EXPECT_TRUE(std::abs(found - expected) <= 1e-11 * std::abs(expected)) << what << ": expected " << expected << ", found " << found;
  std::cout << "  " << what << ' ' << std::abs(found - expected) / std::abs(expected) << '\n';
}

Json peers() { return test::read_json(shared_folder() / "golden/peers_tum_fr1.json"); }

TEST_F(TumFr1, WhatMapEvalPrints) {
  const Json golden = peers().at("mapeval");
  const Json& found = evaluation_->aliases.at("mapeval");
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
  const Json& found = evaluation_->aliases.at("open3d");
  for (const Json& expected : golden.at("at")) {
    const auto level = std::find_if(found.at("per_threshold").begin(), found.at("per_threshold").end(), [&](const Json& l) {
      return l.at("threshold_m") == expected.at("threshold_m");
    });
    ASSERT_NE(level, found.at("per_threshold").end());
    EXPECT_EQ(level->at("fitness"), expected.at("fitness"));
    EXPECT_EQ(level->at("correspondences"), expected.at("correspondences"));
    expect_sum(level->at("inlier_rmse"), expected.at("inlier_rmse"), "open3d inlier_rmse");
  }
  for (const char* direction : {"estimate_to_reference", "reference_to_estimate"}) {
    expect_sum(found.at("mean_distance").at(direction), golden.at("mean_distance").at(direction), "open3d mean distance");
  }
}

TEST_F(TumFr1, WhatCloudCompareLogs) {
  const Json golden = peers().at("cloudcompare");
  const Json& found = evaluation_->aliases.at("cloudcompare");
  expect_printed(found.at("mean"), golden.at("mean"), 5, "cloudcompare mean");  // six decimals
  expect_printed(found.at("std"), golden.at("std"), 5, "cloudcompare std");
}

TEST_F(TumFr1, WhatPcErrorPrints) {
  const Json golden = peers().at("mpeg_pc_error");
  const Json& found = evaluation_->aliases.at("mpeg");
  constexpr int kDigits = 9;
  for (const char* direction : {"reference_to_estimate", "estimate_to_reference"}) {
    const Json& ours = found.at(direction);
    expect_printed(ours.at("point_mse"), golden.at("p2point_mse").at(direction), kDigits, "mpeg p2point");
    expect_printed(ours.at("hausdorff_squared"), golden.at("hausdorff_squared").at(direction), kDigits, "mpeg hausdorff");
    for (std::size_t c = 0; c < 3; ++c) {
      expect_printed(ours.at("color_mse")[c], golden.at("color_mse").at(direction)[c], kDigits, "mpeg color mse");
    }
  }
  for (std::size_t c = 0; c < 3; ++c) {
    expect_printed(found.at("symmetric").at("color_psnr")[c], golden.at("color_psnr_symmetric")[c], kDigits, "mpeg psnr");
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
  const Evaluation flann = evaluate(std::move(pair.reference), std::move(pair.estimate), options_of(config));
  const std::size_t n_ties = count_ties(evaluation_->pair.nearest_in_reference, flann.pair.nearest_in_reference) +
                             count_ties(evaluation_->pair.nearest_in_estimate, flann.pair.nearest_in_estimate);
  std::cout << "  " << n_ties << " ties\n";
  test::WorstDifferences worst;
  for (const MetricRecord& record : evaluation_->metrics) {
    const std::string id(record.info->id);
    if (id == "color_distance" || id == "color_fidelity") continue;
    test::RecordComparison({1e-9, 0.0}, worst).compare(id, record.fields, flann.find(id)->fields);
  }
  worst.print("FLANN");
  // A tie changes one term of one mean by sqrt 3 at most.
  const double n_points = fields("color_distance").at("n_estimate");
  EXPECT_NEAR(flann.find("color_distance")->fields.at("value"), fields("color_distance").at("value").get<double>(),
              1e-12 + static_cast<double>(n_ties) * std::numbers::sqrt3 / n_points);
}

// ---- large coordinates --------------------------------------------------------------------------------------------

const Eigen::Vector3d kShift_m(5e5, 4e6, 100);

/// A cloud's points, moved by a shift and written as doubles by nobody's code but this.
fs::path write_double_ply(const fs::path& path, const std::vector<Eigen::Vector3d>& points, const Colors& colors) {
  const bool wide = std::holds_alternative<Array<Rgb16>>(colors);
  const char* type = wide ? "ushort" : "uchar";
  testing::Bytes bytes("ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(points.size()) +
                       "\nproperty double x\nproperty double y\nproperty double z\n");
  for (const char* channel : {"red", "green", "blue"}) bytes.text(std::string("property ") + type + " " + channel + "\n");
  bytes.text("end_header\n");
  for (std::size_t i = 0; i < points.size(); ++i) {
    bytes.put(points[i].x(), points[i].y(), points[i].z());
    for (std::size_t c = 0; c < 3; ++c) {
      if (wide) bytes.put(std::get<Array<Rgb16>>(colors)[i][c]);
      else bytes.put(std::get<Array<Rgb8>>(colors)[i][c]);
    }
  }
  std::ofstream(path, std::ios::binary) << bytes.str();
  return path;
}

std::vector<Eigen::Vector3d> shifted_points(const PointCloud& cloud, const Eigen::Vector3d& shift_m) {
  std::vector<Eigen::Vector3d> points(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) points[i] = cloud.world(i) + shift_m;
  return points;
}

/// The pair read from files of doubles.
Pair through_double_ply(const Pair& pair, const Eigen::Vector3d& shift_m) {
  const testing::TempFolder folder;
  return {read_point_cloud(write_double_ply(folder / "r.ply", shifted_points(pair.reference, shift_m), pair.reference.colors)).cloud,
          read_point_cloud(write_double_ply(folder / "e.ply", shifted_points(pair.estimate, shift_m), pair.estimate.colors)).cloud};
}

Pair with_moved_origin(Pair pair, const Eigen::Vector3d& shift_m) {
  pair.reference.origin += shift_m;
  pair.estimate.origin += shift_m;
  return pair;
}

/// DESIGN, "Large coordinates".
constexpr test::Tolerance kSamePlaceElsewhere{1e-6, 1e-12};

void expect_same_scores(const Pair& pair, const Pair& other, const Json& config, const std::string& title) {
  test::WorstDifferences worst;
  const Evaluation expected = evaluate(pair.reference, pair.estimate, options_of(config));
  const Evaluation found = evaluate(other.reference, other.estimate, options_of(config));
  for (const Warning& warning : found.warnings) EXPECT_NE(warning.id, "precision_reduced");
  test::expect_same_records(expected, found, kSamePlaceElsewhere, worst);
  worst.print(title);
}

Json shifted_tum_options() {
  Json config = kTumOptions;
  config["as"] = Json::array();
  config["ccs-voxel"] = 0.25;
  config["awd-voxel"] = 4;
  return config;
}

TEST(LargeCoordinates, TumFr1ScoresTheSameFarAway) {
  SKIP_WITHOUT(shared_folder() / "data/tum_fr1");
  const Pair pair = read_tum();
  expect_same_scores(pair, with_moved_origin(pair, kShift_m), shifted_tum_options(), "tum_fr1 on a far origin");
  expect_same_scores(pair, through_double_ply(pair, kShift_m), shifted_tum_options(), "tum_fr1 far away, from doubles");
}

const Json kStadiumOptions{{"metrics", {"color+", "geometry", "distribution", "mme"}},
                           {"thresholds", {1.0, 0.5, 0.2, 0.1}},
                           {"ccs-voxel", 0.25},
                           {"awd-voxel", 4},
                           {"awd-min-points", 20},
                           {"mme-radius", 2.0}};

fs::path stadium_path() { return shared_folder() / "data/autzen/stadium_utm.las"; }

double gaussian(std::mt19937_64& random) {
  double sum = -6.0;
  for (int i = 0; i < 12; ++i) sum += test::uniform(random);
  return sum;
}

/// The stadium turned by half a degree about its center, shifted by 15 cm, with 5 cm noise, a tenth of the points
/// missing and darker colors.
PointCloud disturbed(const PointCloud& cloud) {
  const Box3d box = bounds(cloud);
  const Eigen::Vector3d center = 0.5 * (box.min + box.max);
  const Eigen::Matrix3d R = Eigen::AngleAxisd(0.5 * std::numbers::pi / 180.0, Eigen::Vector3d(0.1, 0.2, 1.0).normalized()).toRotationMatrix();
  std::mt19937_64 random(1);
  PointCloud result;
  result.origin = cloud.origin;
  Array<Rgb16> colors;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (test::uniform(random) < 0.1) continue;
    const double nx = gaussian(random), ny = gaussian(random), nz = gaussian(random);
    const Eigen::Vector3d world = R * (cloud.world(i) - center) + center + Eigen::Vector3d(0.1, 0.1, 0.05) + 0.05 * Eigen::Vector3d(nx, ny, nz);
    result.positions.push_back((world - cloud.origin).cast<float>());
    Rgb16 color = std::get<Array<Rgb16>>(cloud.colors)[i];
    for (std::uint16_t& channel : color) channel = static_cast<std::uint16_t>(0.85 * channel + 2000.0 * test::uniform(random));
    colors.push_back(color);
  }
  result.colors = colors;
  return result;
}

template <class T>
T field(const std::string& bytes, std::size_t place) {
  T value;
  std::memcpy(&value, bytes.data() + place, sizeof(T));
  return value;
}

/// The coordinates of a LAS 1.2 file by the specification: integers times scale plus offset.
std::vector<Eigen::Vector3d> las_points(const fs::path& path) {
  const std::string bytes = testing::read_bytes(path);
  const auto first = field<std::uint32_t>(bytes, 96);
  const auto record_bytes = field<std::uint16_t>(bytes, 105);
  std::vector<Eigen::Vector3d> points(field<std::uint32_t>(bytes, 107));
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto raw = field<std::int32_t>(bytes, first + i * record_bytes + 4 * axis);
      points[i][static_cast<Eigen::Index>(axis)] = raw * field<double>(bytes, 131 + 8 * axis) + field<double>(bytes, 155 + 8 * axis);
    }
  }
  return points;
}

TEST(LargeCoordinates, LasAndDoublePlyScoreTheSame) {
  SKIP_WITHOUT(stadium_path());
  const PointCloud las = read_point_cloud(stadium_path()).cloud;
  const PointCloud estimate = disturbed(las);
  const testing::TempFolder folder;
  write_ply(folder / "written.ply", las);
  const PointCloud written = read_point_cloud(folder / "written.ply").cloud;
  expect_same_scores({las, estimate}, {written, estimate}, kStadiumOptions, "stadium, LAS and write_ply");

  const PointCloud by_hand = read_point_cloud(write_double_ply(folder / "hand.ply", las_points(stadium_path()), las.colors)).cloud;
  expect_same_scores({las, estimate}, {by_hand, estimate}, kStadiumOptions, "stadium, LAS and doubles by hand");
}

TEST(LargeCoordinates, TheStadiumScoresTheSameFarAway) {
  SKIP_WITHOUT(stadium_path());
  const PointCloud las = read_point_cloud(stadium_path()).cloud;
  const Pair pair{las, disturbed(las)};
  expect_same_scores(pair, with_moved_origin(pair, kShift_m), kStadiumOptions, "stadium on a farther origin");
  expect_same_scores(pair, through_double_ply(pair, kShift_m), kStadiumOptions, "stadium farther away, from doubles");
}

}  // namespace
}  // namespace cmap

#include <algorithm>
#include <cmath>
#include <functional>

#include "cmap/core/execution.hpp"
#include "cmap/core/parallel.hpp"
#include "cmap/eval/evaluation.hpp"
#include "eval/hand_maps.hpp"

namespace cmap {
namespace evaluation_invariance_test {

using Json = nlohmann::ordered_json;
using test::gray_map;
using test::kEstimate;
using test::kReference;
using test::options_for;
using test::painted_sheet;

/// Everything that was found, with the options of every kind of metric.
Json everything(const Evaluation& evaluation) {
  Json all = test::fields_of(evaluation.metrics);
  for (const PeerRecord& peer : evaluation.peers) all["aliases"][peer.tool] = test::peer_fields(evaluation, peer.tool);
  all["overlap"] = evaluation.overlap;
  all["rmse_m"] = evaluation.rmse_m;
  for (const Warning& warning : evaluation.warnings) all["warnings"][warning.id] = warning.message;
  return all;
}

EvaluationOptions all_options() {
  EvaluationOptions options = options_for({"all"});
  options.lcr_curve = true;
  options.as = test::tools({"color-map-evaluation", "cloudanalyzer", "mapeval", "open3d", "mpeg", "cloudcompare"});
  options.mme_radius_m = 0.3;
  options.ccs_voxel_m = 0.5;
  return options;
}

TEST(EvaluationInvariance, IsBitwiseTheSameForAnyNumberOfThreads) {
  // More than one chunk of every parallel loop.
  const PointCloud reference = painted_sheet(kLoopChunk + 5000, 1), estimate = painted_sheet(kLoopChunk + 1000, 2);
  std::vector<std::string> found;
  for (int threads : {1, 2, 3, 8}) {
    const ExecutionScope limit({.threads = threads});
    found.push_back(everything(evaluate(reference, estimate, all_options())).dump());
  }
  for (const std::string& other : found) EXPECT_EQ(other, found.front());
}

PointCloud reversed(const PointCloud& map) {
  PointCloud result = map;
  std::ranges::reverse(result.positions);
  std::ranges::reverse(std::get<Array<Rgb8>>(result.colors));
  return result;
}

/// The same structure, and numbers that differ by their summation at most.
void expect_equal_numbers(const Json& a, const Json& b, const std::string& place) {
  ASSERT_EQ(a.type(), b.type()) << place;
  if (a.is_number_float()) {
    EXPECT_NEAR(a.get<double>(), b.get<double>(), 1e-11 * std::abs(a.get<double>())) << place;
  } else if (a.is_structured()) {
    ASSERT_EQ(a.size(), b.size()) << place;
    for (auto x = a.items().begin(), y = b.items().begin(); x != a.items().end(); ++x, ++y) {
      expect_equal_numbers(x.value(), y.value(), place + "/" + x.key());
    }
  } else {
    EXPECT_EQ(a, b) << place;
  }
}

TEST(EvaluationInvariance, TheOrderOfThePointsDoesNotMatter) {
  const PointCloud reference = painted_sheet(5000, 1), estimate = painted_sheet(4000, 2);
  EvaluationOptions options = all_options();
  options.no_levels = true;  // the order draws the reference's halves
  expect_equal_numbers(everything(evaluate(reference, estimate, options)),
                       everything(evaluate(reversed(reference), reversed(estimate), options)), "");
}

TEST(EvaluationInvariance, FlannFindsTheSame) {
  const PointCloud reference = painted_sheet(5000, 1), estimate = painted_sheet(4000, 2);
  EvaluationOptions flann = all_options();
  flann.index = IndexKind::kFlann;
  expect_equal_numbers(everything(evaluate(reference, estimate, all_options())),
                       everything(evaluate(reference, estimate, flann)), "");
}

TEST(EvaluationInvariance, NoRecordHoldsANumberThatIsNotFinite) {
  // JSON has no NaN: nlohmann writes null for it, and a reader of the library would see it.
  const std::function<void(const Json&, const std::string&)> check = [&](const Json& value, const std::string& place) {
    if (value.is_number_float()) {
      EXPECT_TRUE(std::isfinite(value.get<double>())) << place;
    } else if (value.is_structured()) {
      for (const auto& [key, item] : value.items()) check(item, place + "/" + key);
    }
  };
  PointCloud far = kEstimate;
  far.origin = {100, 0, 0};
  for (const PointCloud& estimate : {kEstimate, kReference, far, gray_map({{0, 0, 0}})}) {
    check(everything(evaluate(kReference, estimate, all_options())), "");
  }
}

}  // namespace evaluation_invariance_test
}  // namespace cmap

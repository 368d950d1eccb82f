// The conformance set of data_samples/: every number that expected.json holds, for every pair.

#include <algorithm>
#include <vector>

#include "cmap/eval/configuration.hpp"
#include "cmap/io/point_cloud_file.hpp"
#include "conformance/records.hpp"

namespace cmap {
namespace conformance_test {

namespace fs = std::filesystem;
using test::Json;

/// Folders with an expected.json, by name: town, micro/ties ...
std::vector<std::string> sample_names() {
  std::vector<std::string> names;
  const fs::path root = test::source_folder() / "data_samples";
  if (!fs::is_directory(root)) return names;
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    if (entry.path().filename() == "expected.json")
      names.push_back(fs::relative(entry.path().parent_path(), root).string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// Both implementations work in double from the same float coordinates; what is left is the order of sums, and for the
/// entropy and the Wasserstein distance an eigenvalue or determinant that keeps ten digits of sixteen. Below 1e-12
/// there is nothing but rounding where 0 is expected.
constexpr test::Tolerance kTolerance{1e-9, 1e-12};

class Conformance : public testing::TestWithParam<std::string> {
 protected:
  static void TearDownTestSuite() { worst_.print("conformance set"); }

  /// The evaluation of a sample with all metrics and its own options.
  static Evaluation evaluate_sample(const std::string& name, const Json& expected, IndexKind index) {
    const fs::path folder = test::source_folder() / "data_samples" / name;
    EvaluationOptions options;
    options.metrics = {"all"};
    options.index = index;
    apply_config(options, expected.at("options").dump(), (folder / "expected.json").string());
    return evaluate(read_point_cloud(folder / "reference.ply").cloud, read_point_cloud(folder / "estimate.ply").cloud,
                    options);
  }

  static void expect_metrics(const Json& expected, const Evaluation& found) {
    EXPECT_EQ(expected.at("metrics").size(), metric_list().size()) << "every metric has an expected record";
    for (const auto& [id, record] : expected.at("metrics").items()) {
      SCOPED_TRACE(id);
      // A metric that has nothing at all is null in the set and a null value in a report.
      const Json wanted = record.is_null() ? Json{{"value", nullptr}} : record;
      test::RecordComparison(kTolerance, worst_).compare(id, wanted, test::fields_of(found, id));
    }
  }

  static Json expected_of(const std::string& name) {
    return test::read_json(test::source_folder() / "data_samples" / name / "expected.json");
  }

  static inline test::WorstDifferences worst_;
};

TEST_P(Conformance, EveryNumberIsAsExpected) {
  const Json expected = expected_of(GetParam());
  expect_metrics(expected, evaluate_sample(GetParam(), expected, IndexKind::kBvh));
}

INSTANTIATE_TEST_SUITE_P(DataSamples, Conformance, testing::ValuesIn(sample_names()), [](const auto& sample) {
  std::string name = sample.param;
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
});

class ConformanceWithFlann : public Conformance {};

TEST_P(ConformanceWithFlann, EveryNumberIsAsExpected) {
  const Json expected = expected_of(GetParam());
  expect_metrics(expected, evaluate_sample(GetParam(), expected, IndexKind::kFlann));
}

// Two nearest points are never equally near in these, so that FLANN's choice is the set's.
INSTANTIATE_TEST_SUITE_P(WithoutTies, ConformanceWithFlann,
                         testing::Values("town", "micro/color_shift", "micro/two_points"),
                         [](const auto& sample) { return std::to_string(sample.index); });

TEST(ConformanceSet, IsFound) {
  const std::vector<std::string> names = sample_names();
  for (const char* name : {"town", "micro/ties", "micro/no_color"}) {
    EXPECT_EQ(std::count(names.begin(), names.end(), name), 1) << name << " below " << test::source_folder();
  }
}

}  // namespace conformance_test
}  // namespace cmap

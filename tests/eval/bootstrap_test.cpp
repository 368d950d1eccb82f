#include "cmap/eval/bootstrap.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>

#include "cmap/core/execution.hpp"
#include "eval/eval_testing.hpp"

namespace cmap {
namespace bootstrap_test {

using test::options_for;
using test::refusal_of;
using test::uniform;
using ::testing::Contains;
using ::testing::HasSubstr;

/// Values by "id" and "id@threshold".
using Values = std::map<std::string, double>;

void add_finite(Values& values, const SummedValue& v) {
  if (!std::isfinite(v.value)) return;
  values[v.threshold_m ? fmt::format("{}@{}", v.id, *v.threshold_m) : std::string(v.id)] = v.value;
}

/// Of the records.
Values reported(const Evaluation& evaluation) {
  Values values;
  for (const MetricRecord& metric : evaluation.metrics) {
    for (const SummedValue& v : values_of(metric.info->id, metric.record)) add_finite(values, v);
  }
  return values;
}

/// The same of sums over all of the blocks.
Values summed(const BlockSums& blocks, const MetricOptions& options) {
  Values values;
  const std::vector<double> once(blocks.keys.size(), 1.0);
  for (const SummedValue& v : MetricFormulas(blocks.sums, MetricSettings(options)).values(once)) add_finite(values, v);
  return values;
}

const MetricSettings kSettings{MetricOptions{}};

Evaluation evaluated_with_blocks(std::uint64_t seed = 1) {
  EvaluationOptions options = options_for({"all"});
  options.bootstrap = 50;
  options.bootstrap_seed = seed;
  options.block_m = 4.0;
  options.awd_min_points = 10;
  options.mme_radius_m = 1.0;
  options.color_max_distance_m = 2.0;
  options.thresholds_m = {1.0, 0.25};
  return evaluate(test::painted_sheet(4000, 1), test::painted_sheet(3000, 2), options);
}

/// Blocks are rounded to double each, the whole once.
TEST(Bootstrap, SumsOverAllBlocksGiveTheValuesOfTheReport) {
  const Evaluation evaluation = evaluated_with_blocks();
  Values expected = reported(evaluation);
  const Values found = summed(evaluation.intervals->blocks, evaluation.options);
  for (const Metric* metric : metric_list()) {
    if (metric->value == nullptr) expected.erase(std::string(metric->info.id));  // no mean nor share
  }
  ASSERT_EQ(found.size(), expected.size());
  for (const auto& [name, value] : expected) {
    ASSERT_TRUE(found.contains(name)) << name;
    EXPECT_NEAR(found.at(name), value, 1e-11 * std::abs(value)) << name;
  }
}

TEST(Bootstrap, EveryIntervalHoldsItsValue) {
  const Evaluation evaluation = evaluated_with_blocks();
  for (const Interval& v : evaluation.intervals->metrics) {
    EXPECT_LE(v.lower, v.value) << v.id;
    EXPECT_GE(v.upper, v.value) << v.id;
    EXPECT_LT(v.lower, v.upper) << v.id;
  }
  EXPECT_EQ(std::ranges::count(evaluation.intervals->metrics, "hausdorff", &Interval::id), 0);
}

/// Blocks with these means of distance, ten points each.
BlockSums blocks_of(const std::vector<double>& means) {
  BlockSums blocks{1.0, {}, {means.size(), {}}};
  for (std::size_t i = 0; i < means.size(); ++i) {
    blocks.keys.push_back({static_cast<std::int64_t>(i), 0, 0});
    for (const char* map : {"estimate", "reference"}) {
      const auto column = [&](const char* name) -> std::vector<double>& {
        return blocks.sums.columns[fmt::format("chamfer.{}.{}", map, name)];
      };
      column("n").push_back(10.0);
      column("distance").push_back(10.0 * means[i]);
      column("sq_distance").push_back(10.0 * means[i] * means[i]);
      column("truncated").push_back(10.0 * means[i]);
    }
  }
  return blocks;
}

const Interval& chamfer_of(const std::vector<Interval>& intervals) {
  return *std::ranges::find(intervals, "chamfer", &Interval::id);
}

TEST(Bootstrap, BlocksThatAreAlikeLeaveNoDoubt) {
  const std::vector<Interval> intervals = bootstrap(blocks_of({0.5, 0.5, 0.5}), kSettings, {});
  EXPECT_EQ(chamfer_of(intervals).value, 1.0);
  EXPECT_EQ(chamfer_of(intervals).lower, 1.0);
  EXPECT_EQ(chamfer_of(intervals).upper, 1.0);
}

/// Of two blocks a replicate draws both with probability 1/2, and one of them twice with 1/4 each: the percentiles of
/// Chamfer distances 0, 1 and 2 by hand.
TEST(Bootstrap, TwoBlocksByHand) {
  const Interval all = chamfer_of(bootstrap(blocks_of({0.0, 1.0}), kSettings, {.n_replicates = 2000}));
  EXPECT_EQ(all.lower, 0.0);
  EXPECT_EQ(all.value, 1.0);
  EXPECT_EQ(all.upper, 2.0);
  const Interval middle = chamfer_of(bootstrap(blocks_of({0.0, 1.0}), kSettings, {.n_replicates = 2000, .level = 0.4}));
  EXPECT_EQ(middle.lower, 1.0);  // a quarter lies below, 30 % are cut off
  EXPECT_EQ(middle.upper, 1.0);
}

/// Truth: blocks' means are uniform in [0, 1], so that Chamfer is 1. 1000 trials know the coverage to 0.7 %.
TEST(Bootstrap, CoversTheTruthAtItsLevel) {
  constexpr int kTrials = 1000;
  std::mt19937_64 random(7);
  int covered = 0, difference_covered = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<double> means(80), better(80);
    for (std::size_t i = 0; i < means.size(); ++i) {
      means[i] = uniform(random);
      better[i] = means[i] - 0.1 * uniform(random);  // on average 0.05 a direction
    }
    const BootstrapOptions options{.n_replicates = 200, .seed = 1000u * static_cast<unsigned>(trial)};
    const Interval found = chamfer_of(bootstrap(blocks_of(means), kSettings, options));
    covered += found.lower <= 1.0 && 1.0 <= found.upper ? 1 : 0;
    const Interval difference =
        chamfer_of(bootstrap_difference(blocks_of(means), kSettings, blocks_of(better), kSettings, options));
    difference_covered += difference.lower <= -0.1 && -0.1 <= difference.upper ? 1 : 0;
    EXPECT_LT(difference.upper - difference.lower, 0.3 * (found.upper - found.lower)) << "what both share cancels";
  }
  EXPECT_NEAR(static_cast<double>(covered) / kTrials, 0.95, 0.03);
  EXPECT_NEAR(static_cast<double>(difference_covered) / kTrials, 0.95, 0.03);
}

TEST(Bootstrap, DifferencesAreTakenBlockByBlock) {
  BlockSums a = blocks_of({0.25, 0.75, 0.5});
  BlockSums b = blocks_of({0.25, 0.75, 0.5});
  b.keys = {{1, 0, 0}, {2, 0, 0}, {3, 0, 0}};  // one block further
  const Interval same = chamfer_of(bootstrap_difference(a, kSettings, a, kSettings, {}));
  EXPECT_EQ(same.lower, 0.0);
  EXPECT_EQ(same.upper, 0.0);
  const Interval moved = chamfer_of(bootstrap_difference(a, kSettings, b, kSettings, {}));
  EXPECT_EQ(moved.value, 0.0);
  EXPECT_LT(moved.lower, 0.0) << "other blocks, so that nothing cancels";
  b.block_m = 2.0;
  EXPECT_THROW(bootstrap_difference(a, kSettings, b, kSettings, {}), std::invalid_argument);
}

/// One estimate evaluated with two lists of thresholds: nothing differs, whatever the bands are.
TEST(Bootstrap, EachIsReadWithItsOwnThresholds) {
  EvaluationOptions few = options_for({"geometry"}), many = few;
  few.bootstrap = many.bootstrap = 20;
  few.block_m = many.block_m = 4.0;
  few.thresholds_m = {0.2, 0.1};
  many.thresholds_m = {0.2, 0.15, 0.1, 0.05};
  const PointCloud reference = test::painted_sheet(2000, 1), estimate = test::painted_sheet(1500, 2);
  const Evaluation a = evaluate(reference, estimate, few), b = evaluate(reference, estimate, many);
  const std::vector<Interval> differences = bootstrap_difference(
      a.intervals->blocks, MetricSettings(few), b.intervals->blocks, MetricSettings(many), {.n_replicates = 20});
  EXPECT_GT(differences.size(), 10U);
  for (const Interval& v : differences) {
    EXPECT_NEAR(v.lower, 0.0, 1e-12) << v.id;
    EXPECT_NEAR(v.upper, 0.0, 1e-12) << v.id;
  }
}

TEST(Bootstrap, WhichMetricsAreAskedForChangesNoBlock) {
  EvaluationOptions options = options_for({"chamfer"});
  options.bootstrap = 20;
  options.block_m = 1.0;
  options.awd_voxel_m = 5.0;  // whose centers lie where no point is
  options.awd_min_points = 10;
  const PointCloud reference = test::painted_sheet(2000, 1), estimate = test::painted_sheet(1500, 2);
  const Evaluation alone = evaluate(reference, estimate, options);
  options.metrics = {"chamfer", "AWD", "CCS"};
  const Evaluation more = evaluate(reference, estimate, options);
  EXPECT_EQ(more.intervals->blocks.keys, alone.intervals->blocks.keys);
  EXPECT_EQ(chamfer_of(more.intervals->metrics).lower, chamfer_of(alone.intervals->metrics).lower);
}

TEST(Bootstrap, AnotherSeedDrawsOtherBlocksOfTheSameValues) {
  const Evaluation first = evaluated_with_blocks(1), second = evaluated_with_blocks(2);
  const Interval &one = chamfer_of(first.intervals->metrics), &two = chamfer_of(second.intervals->metrics);
  EXPECT_EQ(one.value, two.value);
  EXPECT_NE(one.lower, two.lower);
  EXPECT_EQ(second.intervals->options.seed, 2U);
}

TEST(Bootstrap, TheSameForAnyNumberOfThreads) {
  const auto intervals = [] { return intervals_json(*evaluated_with_blocks().intervals).dump(); };
  const std::string all = intervals();
  const ExecutionScope one({.threads = 1});
  EXPECT_EQ(intervals(), all);
}

TEST(Bootstrap, BlocksComeBackFromAReport) {
  const BlockSums blocks = blocks_of({0.1, 0.2});
  const BlockSums again = block_sums_from(block_sums_json(blocks));
  EXPECT_EQ(again.keys, blocks.keys);
  EXPECT_EQ(again.block_m, blocks.block_m);
  EXPECT_EQ(again.sums.columns, blocks.sums.columns);
}

TEST(Bootstrap, DamagedBlocksAreRefused) {
  const nlohmann::ordered_json good = block_sums_json(blocks_of({0.1, 0.2}));
  const auto refused = [&](const std::function<void(nlohmann::ordered_json&)>& damage) {
    nlohmann::ordered_json bad = good;
    damage(bad);
    return refusal_of<UsageError>([&] { block_sums_from(bad); });
  };
  EXPECT_THAT(refused([](auto& json) { json.erase("keys"); }), HasSubstr("damaged"));
  EXPECT_THAT(refused([](auto& json) { json["keys"] = 7; }), HasSubstr("damaged"));
  EXPECT_THAT(refused([](auto& json) { json["sums"]["chamfer.estimate.n"].push_back(1.0); }), HasSubstr("damaged"));
  EXPECT_THAT(refused([](auto& json) { std::swap(json["keys"][0], json["keys"][1]); }), HasSubstr("damaged"));
}

TEST(Bootstrap, FewBlocksGiveAWarning) {
  EvaluationOptions options = options_for({"chamfer"});
  options.bootstrap = 10;
  options.block_m = 1000.0;
  const Evaluation evaluation = evaluate(test::painted_sheet(100, 1), test::painted_sheet(100, 2), options);
  EXPECT_THAT(test::warning_ids(evaluation.warnings), Contains("intervals_few_blocks"));
}

TEST(Bootstrap, NobodyAskedNothingIsThere) {
  const Evaluation evaluation = evaluate(test::painted_sheet(100, 1), test::painted_sheet(100, 2), {});
  EXPECT_FALSE(evaluation.intervals.has_value());
  EXPECT_FALSE(evaluation.unobserved.has_value());
}

}  // namespace bootstrap_test
}  // namespace cmap

#include "cmap/eval/requirement.hpp"

#include "eval/eval_testing.hpp"

namespace cmap {
namespace requirement_test {

using test::options_for;
using test::refusal_of;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// Records as evaluations make them.
MetricRecords records(double fidelity_db, double psnr_db) {
  std::vector<MetricRecord> made;
  const auto add = [&](const char* id, Record record) { made.push_back({find_metric(id), std::move(record)}); };
  add("local_color_recall", Record{.value = 0.25}.add("coverage", 0.5).add("conditional", NAN));
  add("color_fidelity", Record{.value = fidelity_db});
  add("color_psnr", Record{.value = psnr_db});
  add("chamfer", Record{.value = 0.125}.add("variants", Record{}.add("l1_mean", 0.0625)).add("note", "text"));
  add("accuracy",
      Record{}.add("per_threshold", std::vector{Record{.threshold_m = 0.2, .value = 0.05}.add("median", 0.04),
                                                Record{.threshold_m = 0.1, .value = NAN}.add("median", NAN)}));
  add("color_distance_by_range", Record{}.add("per_range", std::vector{Record{.value = 0.01}.add("lo_m", 0.0)}));
  return MetricRecords(std::move(made));
}

Evaluation evaluation(double fidelity_db = NAN, double psnr_db = NAN) {
  return {.metrics = records(fidelity_db, psnr_db)};
}

EvaluationOptions all_metrics() {
  EvaluationOptions options = options_for({"all"});
  options.thresholds_m = {0.2, 0.1};
  return options;
}

RequirementOutcome outcome(const std::string& text) {
  return check(parse_requirement(text, all_metrics()), evaluation());
}

std::string refusal(const std::string& text) {
  return refusal_of<UsageError>([&] { outcome(text); });
}

TEST(Requirement, EveryComparisonDecidesAtItsBound) {
  for (const char* holds : {"LCR>=0.25", "LCR<=0.25", "LCR==0.25", "LCR>0.2", "LCR<0.3"})
    EXPECT_TRUE(outcome(holds).holds) << holds;
  for (const char* fails : {"LCR>0.25", "LCR<0.25", "LCR==0.2", "LCR>=0.3", "LCR<=0.2"})
    EXPECT_FALSE(outcome(fails).holds) << fails;
  EXPECT_EQ(outcome("LCR>=0.3").value, 0.25);
}

TEST(Requirement, TakesIdsAndSymbolsInAnyCase) {
  for (const char* text : {"local_color_recall>=0.25", "Local_Color_Recall>=0.25", "lcr>=0.25", "CD#<=0.125",
                           "cd#<=0.125", "chamfer<=0.125", "CHAMFER<=0.125", "AC@0.2<=0.05", "ac@0.2<=0.05"}) {
    EXPECT_TRUE(outcome(text).holds) << text;
  }
}

TEST(Requirement, TakesBlanksAndEveryNotationOfANumber) {
  for (const char* text :
       {" LCR >= 2.5e-1 ", "LCR>=+0.25", "LCR>=-1", "LCR>=.25", "accuracy@2e-1<=0.05", "accuracy@0.20<=0.05"}) {
    EXPECT_TRUE(outcome(text).holds) << text;
  }
}

TEST(Requirement, TakesSharesInPercent) {
  for (const char* holds : {"LCR>=25%", "LCR>=25 %", "LCR<=25%", "LCR==25%", "LCR.coverage>=50%", "LCR>=2.5e1%"})
    EXPECT_TRUE(outcome(holds).holds) << holds;
  for (const char* fails : {"LCR>=26%", "LCR>25%"}) EXPECT_FALSE(outcome(fails).holds) << fails;
  EXPECT_EQ(parse_requirement("LCR>=20%", all_metrics()).bound, 0.2);
  for (const char* text : {"accuracy@0.2<=5%", "CF>=20%", "SCS<=5%"})
    EXPECT_THAT(refusal(text), HasSubstr("is no share: a bound in % has no meaning")) << text;
}

TEST(Requirement, SelectsOneThreshold) {
  const Requirement requirement = parse_requirement("accuracy@0.2<=0.06", all_metrics());
  EXPECT_EQ(requirement.metric->id, "accuracy");
  EXPECT_EQ(requirement.threshold_m, 0.2);
  EXPECT_EQ(requirement.bound, 0.06);
  EXPECT_TRUE(check(requirement, evaluation()).holds);
}

TEST(Requirement, SelectsAFieldByItsPath) {
  EXPECT_EQ(outcome("LCR.coverage>=0.5").value, 0.5);
  EXPECT_EQ(outcome("chamfer.variants.l1_mean<=1").value, 0.0625);
  EXPECT_EQ(outcome("accuracy.median@0.2<=1").value, 0.04);
  EXPECT_EQ(outcome("color_distance_by_range.per_range.0.value<=1").value, 0.01);
}

TEST(Requirement, ANullFailsWhateverTheComparison) {
  for (const char* text :
       {"LCR.conditional>=0", "LCR.conditional<=1", "CF>=0", "CF<=1e9", "accuracy@0.1<=1", "CF==0"}) {
    EXPECT_FALSE(outcome(text).holds) << text;
    EXPECT_EQ(outcome(text).value, std::nullopt) << text;
  }
  EXPECT_FALSE(outcome("color_fidelity.whatever>=0").holds) << "a metric without a value has no other fields";
}

TEST(Requirement, AnInfiniteFidelityIsBestOfAll) {
  const Evaluation exact = evaluation(INFINITY);
  const auto holds = [&](const char* text) { return check(parse_requirement(text, all_metrics()), exact).holds; };
  for (const char* text : {"CF>=0", "CF>=1e300", "CF>40", "color_fidelity.value>=40"}) EXPECT_TRUE(holds(text)) << text;
  for (const char* text : {"CF<=1e300", "CF<0", "CF==40"}) EXPECT_FALSE(holds(text)) << text;
  EXPECT_EQ(check(parse_requirement("CF<=1", all_metrics()), exact).value, INFINITY);
  EXPECT_FALSE(holds("LCR.conditional>=0")) << "what is missing fails as ever";
  EXPECT_FALSE(holds("PSNR>=40"));
  EXPECT_TRUE(check(parse_requirement("PSNR>=40", all_metrics()), evaluation(NAN, INFINITY)).holds);
}

TEST(Requirement, OfOneMap) {
  MapEvaluation map;
  map.metrics = MetricRecords({{find_metric("point_spacing"), Record{.value = 0.25}.add("mean", NAN)}});
  const auto found = [&](const char* text) { return check(parse_map_requirement(text, {}), map); };
  EXPECT_TRUE(found("point_spacing<=0.25").holds);
  EXPECT_FALSE(found("point_spacing<0.25").holds);
  EXPECT_FALSE(found("point_spacing.mean>=0").holds);
  EXPECT_EQ(refusal_of<UsageError>([&] { found("LCR>=0.2"); }),
            "require \"LCR>=0.2\": local_color_recall needs a reference map, which is missing");
  EXPECT_THAT(refusal_of<UsageError>([&] { parse_map_requirement("MME<=0", options_for({"density"})); }),
              HasSubstr("mean_map_entropy is not computed; add it to --metrics"));
}

TEST(Requirement, RefusesWhatIsNoCondition) {
  for (const char* text : {"", "LCR", "LCR>=", ">=0.2", "LCR=0.2", "LCR=>0.2", "LCR>=0.2 m", "LCR>=0.2,CD<=1", "LCR!=1",
                           "LCR>=abc", "LCR..x>=1", "accuracy@<=1"}) {
    EXPECT_THAT(refusal(text),
                AllOf(StartsWith("require \"" + std::string(text) + "\": "), HasSubstr("expected METRIC")))
        << text;
  }
}

TEST(Requirement, RefusesWhatIsNoNumber) {
  for (const char* text : {"LCR>=1.2.3", "LCR>=e", "LCR>=--1", "accuracy@1.1.1<=1"}) {
    EXPECT_THAT(refusal(text), HasSubstr("is not a number")) << text;
  }
}

TEST(Requirement, RefusesABoundThatIsNotFinite) {
  EXPECT_THAT(refusal("chamfer<=1e999"), HasSubstr("\"1e999\" is not a number")) << "it would hold for every map";
}

TEST(Requirement, RefusesAnUnknownMetric) {
  EXPECT_EQ(refusal("lidar>=1"), "require \"lidar>=1\": unknown metric \"lidar\"");
  EXPECT_EQ(refusal("acuracy@0.2<=1"),
            "require \"acuracy@0.2<=1\": unknown metric \"acuracy\"; did you mean accuracy?");
}

TEST(Requirement, RefusesAMetricThatIsNotComputed) {
  const auto parse = [] { parse_requirement("LCR>=0.2", options_for({"geometry"})); };
  EXPECT_THAT(refusal_of<UsageError>(parse),
              AllOf(HasSubstr("local_color_recall is not computed"), HasSubstr("--metrics")));
}

TEST(Requirement, RefusesAWrongThreshold) {
  EXPECT_THAT(refusal("accuracy<=1"), HasSubstr("one value for each threshold: write accuracy@0.2"));
  EXPECT_THAT(refusal("accuracy@0.3<=1"), HasSubstr("0.3 m is not among the thresholds"));
  EXPECT_THAT(refusal("chamfer@0.2<=1"), HasSubstr("chamfer has no thresholds"));
}

TEST(Requirement, RefusesAnUnknownField) {
  EXPECT_THAT(refusal("LCR.covrage>=0.5"), HasSubstr("local_color_recall has no number covrage"));
  EXPECT_THAT(refusal("accuracy.mode@0.2<=1"), HasSubstr("accuracy has no number mode"));
  EXPECT_THAT(refusal("chamfer.variants<=1"), HasSubstr("chamfer has no number variants"));
  EXPECT_THAT(refusal("chamfer.note<=1"), HasSubstr("chamfer has no number note"));
  EXPECT_THAT(refusal("color_distance_by_range<=1"), HasSubstr("color_distance_by_range has no number value"));
}

}  // namespace requirement_test
}  // namespace cmap

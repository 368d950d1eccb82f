#include "cmap/eval/metric_catalog.hpp"

#include <algorithm>
#include <cctype>

#include "eval/eval_testing.hpp"

namespace cmap {
namespace metric_catalog_test {

using test::options_for;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

using Ids = std::set<std::string_view>;

/// The metrics of some groups.
Ids in_groups(const Ids& groups) {
  Ids ids;
  for (const Metric* metric : metric_list()) {
    if (groups.contains(metric->info.group)) ids.insert(metric->info.id);
  }
  return ids;
}

const Ids kColor = in_groups({"color"}), kGeometry = in_groups({"geometry"}),
          kDistribution = in_groups({"distribution"}), kEntropy = in_groups({"mme"}), kDensity = in_groups({"density"});

Ids all_of(std::initializer_list<Ids> groups) {
  Ids all;
  for (const Ids& group : groups) all.insert(group.begin(), group.end());
  return all;
}

Ids ids_of(std::vector<std::string> metrics) { return select_metrics(options_for(std::move(metrics))).ids; }

/// What docs/METRICS.md says of each is compared by tests/docs/links_test.py.
TEST(MetricCatalog, EveryMetricSaysWhatItIs) {
  Ids names;
  for (const Metric* metric : metric_list()) {
    const MetricInfo& info = metric->info;
    SCOPED_TRACE(info.id);
    EXPECT_TRUE(names.insert(info.id).second) << "no name twice";
    if (!info.symbol.empty()) {
      EXPECT_TRUE(names.insert(info.symbol).second) << "no name twice";
    }
    EXPECT_EQ(metric_of(info.id), metric);
    EXPECT_FALSE(info.title.empty() || info.unit.empty() || info.definition.empty());
    EXPECT_TRUE(info.better.empty() || info.better == "lower" || info.better == "higher");
    EXPECT_TRUE((Ids{"color", "color+", "geometry", "distribution", "mme", "density"}.contains(info.group)));
    EXPECT_TRUE(metric->value != nullptr || metric->finish != nullptr) << "it has a value";
    EXPECT_EQ(info.needs_color, info.group == "color" || info.group == "color+");
  }
}

std::string in_case(std::string_view text, int (*convert)(int)) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(convert(static_cast<unsigned char>(c)));
  return result;
}

TEST(FindMetric, TakesIdsAndSymbolsInAnyCase) {
  for (const Metric* known : metric_list()) {
    const MetricInfo& metric = known->info;
    for (std::string_view name : {metric.id, metric.symbol}) {
      if (name.empty()) continue;
      EXPECT_EQ(find_metric(in_case(name, std::tolower)), &metric) << name;
      EXPECT_EQ(find_metric(in_case(name, std::toupper)), &metric) << name;
    }
  }
}

TEST(FindMetric, FindsNothingElse) {
  for (const char* name : {"", "colour_distance", "LCR ", "CD##", "color", "chamfe"})
    EXPECT_EQ(find_metric(name), nullptr) << name;
}

TEST(SelectMetrics, DefaultIsColorGeometryAndDistribution) {
  const MetricSelection selection = select_metrics(EvaluationOptions{});
  EXPECT_EQ(selection.ids, all_of({kColor, kGeometry, kDistribution}));
  EXPECT_FALSE(selection.color_is_required);
}

TEST(SelectMetrics, TakesGroupsAndIds) {
  EXPECT_EQ(ids_of({"color"}), kColor);
  EXPECT_TRUE(kColor.contains("local_color_recall") && !kColor.contains("color_psnr"));
  EXPECT_EQ(ids_of({"color+"}), in_groups({"color", "color+"}));
  EXPECT_EQ(ids_of({"geometry"}), kGeometry);
  EXPECT_EQ(ids_of({"distribution"}), kDistribution);
  EXPECT_EQ(ids_of({"mme"}), kEntropy);
  EXPECT_EQ(ids_of({"density"}), kDensity);
  EXPECT_EQ(ids_of({"all"}), in_groups({"color", "color+", "geometry", "distribution", "mme", "density"}));
  EXPECT_EQ(ids_of({"delta_e", "chamfer"}), (Ids{"chamfer", "delta_e"}));
  EXPECT_EQ(ids_of({"mme", "mean_map_entropy"}), kEntropy);
}

TEST(SelectMetrics, SymbolsAndAnyCaseNameAMetric) {
  EXPECT_EQ(ids_of({"LCR", "cd#", "RMSE"}), (Ids{"local_color_recall", "chamfer", "rmse"}));
}

TEST(SelectMetrics, ColorIsRequiredWhereItIsNamed) {
  const auto required = [](std::vector<std::string> metrics) {
    return select_metrics(options_for(std::move(metrics))).color_is_required;
  };
  for (const char* name : {"color", "color+", "local_color_recall", "delta_e"}) EXPECT_TRUE(required({name})) << name;
  for (const char* name : {"all", "geometry", "mme", "chamfer"}) EXPECT_FALSE(required({name})) << name;
  EXPECT_TRUE(required({"all", "color"}));
}

Ids map_ids_of(std::vector<std::string> metrics) { return select_map_metrics(options_for(std::move(metrics))).ids; }

const Ids kOfOneMap{"color_consistency", "mean_map_entropy", "point_spacing"};

TEST(SelectMapMetrics, TakesWhatNeedsNoReference) {
  EXPECT_EQ(map_ids_of({}), kOfOneMap);
  EXPECT_EQ(map_ids_of({"default"}), kOfOneMap);
  EXPECT_EQ(map_ids_of({"all"}), kOfOneMap);
  EXPECT_EQ(map_ids_of({"color"}), Ids{"color_consistency"});
  EXPECT_EQ(map_ids_of({"mme", "density"}), (Ids{"mean_map_entropy", "point_spacing"}));
  EXPECT_EQ(map_ids_of({"CCS"}), Ids{"color_consistency"});
  EXPECT_TRUE(select_map_metrics(options_for({"color"})).color_is_required);
  EXPECT_FALSE(select_map_metrics(options_for({"all"})).color_is_required);
}

TEST(SelectMapMetrics, NamesTheReferenceThatIsMissing) {
  for (const char* name : {"chamfer", "LCR", "geometry", "distribution", "color_psnr"}) {
    EXPECT_EQ(test::refusal_of<UsageError>([&] {
                map_ids_of({"mme", name});
              }),
              std::string("metrics: ") + name +
                  " needs a reference map, which is missing; without one there are color_consistency, "
                  "mean_map_entropy, point_spacing");
  }
  EXPECT_THAT(test::refusal_of<UsageError>([] { map_ids_of({"lidar"}); }), HasSubstr("\"lidar\" is unknown;"));
  EXPECT_THAT(test::refusal_of<UsageError>([] { map_ids_of({"denisty"}); }),
              HasSubstr("\"denisty\" is unknown; did you mean density?; groups are"));
}

TEST(SelectMapMetrics, RefusesOptionsThatNeedAReference) {
  const auto refusal = [](auto&& change) {
    EvaluationOptions options;
    change(options);
    return test::refusal_of<UsageError>([&] { select_map_metrics(options); });
  };
  EXPECT_EQ(refusal([](auto& o) { o.align.kind = AlignKind::kTrajectory; }),
            "align: needs a reference map, which is missing");
  EXPECT_THAT(refusal([](auto& o) { o.as = test::tools({"open3d"}); }), HasSubstr("as: needs"));
  EXPECT_THAT(refusal([](auto& o) { o.bootstrap = 100; }), HasSubstr("bootstrap: needs"));
  EXPECT_THAT(refusal([](auto& o) { o.observed = Observed::kAuto; }), HasSubstr("observed: needs"));
  EXPECT_THAT(refusal([](auto& o) { o.sensitivity = true; }), HasSubstr("sensitivity: needs"));
}

TEST(SelectMetrics, RefusesAnUnknownName) {
  EXPECT_THAT(test::refusal_of<UsageError>([] {
                ids_of({"geometry", "lidar"});
              }),
              AllOf(HasSubstr("\"lidar\" is unknown"), HasSubstr("distribution, mme, density, all"),
                    HasSubstr("color_fidelity")));
}

}  // namespace metric_catalog_test
}  // namespace cmap

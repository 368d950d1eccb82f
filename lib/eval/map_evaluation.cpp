#include "cmap/eval/map_evaluation.hpp"

#include "cmap/core/error.hpp"
#include "eval/plausibility.hpp"
#include "eval/preparation.hpp"
#include "eval/record_list.hpp"
#include "eval/stage_clock.hpp"

namespace cmap {
namespace {

void check_color(const PointCloud& map, const MetricSelection& selection, std::vector<Warning>& warnings) {
  if (map.has_color() || !selection.contains("color_consistency")) return;
  const std::string message = "the map has no color, which color metrics need";
  if (selection.color_is_required) throw UnsupportedError(message);
  warnings.push_back({"no_color", message + ": they are null"});
}

}  // namespace

MapEvaluation evaluate_map(PointCloud map, const EvaluationOptions& options, const ProgressSink& progress) {
  const MetricSelection selection = select_map_metrics(options);
  std::vector<Warning> warnings;
  std::vector<std::pair<std::string, double>> stage_seconds;
  StageClock clock(stage_seconds, progress);

  drop_missing_colors(map);
  check_color(map, selection, warnings);
  std::optional<CoordinateStep> step;
  clock.run("prepare", 0.15, [&] { step = prepare_map(map, options, selection); });
  std::optional<IndexedMap> indexed;
  clock.run("index", 0.3, [&] {
    indexed.emplace(map);
    map = {};  // its memory is needed
  });
  MapEvaluation result{.options = options, .map = std::move(*indexed)};

  const Bvh& index = result.map.index;
  warn_about_points("map", index.points, sampled_spacing(index), step, options, warnings);
  RecordList records(selection);
  clock.run("color", 0.5, [&] {
    records.add("color_consistency", [&]() -> nlohmann::ordered_json {
      if (!result.map.has_color()) return {{"value", nullptr}};
      return color_consistency_fields(options, result.map, warnings);
    });
  });
  clock.run("entropy", 0.6, [&] {
    records.add("mean_map_entropy", [&] {
      const auto shapes = neighborhood_shapes(index, options.mme_radius_m, result.map.file_step_m);
      return mean_map_entropy_fields(options, shapes, warnings);
    });
  });
  clock.run("density", 0.9,
            [&] { records.add("point_spacing", [&] { return point_spacing_fields(result.map, warnings); }); });
  result.metrics = records.take();
  result.warnings = std::move(warnings);
  result.stage_seconds = std::move(stage_seconds);
  return result;
}

}  // namespace cmap

#include "cmap/eval/map_evaluation.hpp"

#include "cmap/core/error.hpp"
#include "measurement.hpp"
#include "plausibility.hpp"
#include "preparation.hpp"
#include "stage_clock.hpp"

namespace cmap {
namespace {

void check_color(const PointCloud& map, const MetricSelection& selection, std::vector<Warning>& warnings) {
  if (map.has_color() || selected_metrics(selection, true) == selected_metrics(selection, false)) return;
  const std::string message = "the map has no color, which color metrics need";
  if (selection.color_is_required) throw UnsupportedError(message);
  warnings.push_back({"no_color", message + ": they are null"});
}

}  // namespace

EvaluatedMap evaluate_map(PointCloud map, const EvaluationOptions& options, const Execution& execution) {
  const ExecutionScope scope(execution);
  const MetricSelection selection = select_map_metrics(options);
  std::vector<Warning> warnings;
  std::vector<std::pair<std::string, double>> stage_seconds;
  StageClock clock(stage_seconds);

  drop_missing_colors(map);
  check_color(map, selection, warnings);
  std::optional<CoordinateStep> step;
  clock.run("prepare", 0.15, [&] { step = prepare_map(map, options, selection); });
  std::optional<IndexedMap> indexed;
  clock.run("index", 0.3, [&] {
    indexed.emplace(map);
    map = {};  // its memory is needed
  });
  EvaluatedMap result{{.options = options}, std::move(*indexed)};

  const Bvh& index = result.map.index;
  warn_about_points("map", index.points, sampled_spacing(index), step, options, warnings);
  MetricInputs inputs(options, result.map);
  const std::vector<const Metric*> metrics = selected_metrics(selection, result.map.has_color());
  find_fields(metrics, inputs, clock);
  clock.run("sums", 0.9, [&] {
    const WholeSums sums(sum_metrics(metrics, inputs), inputs.settings);
    result.metrics = with_missing(selection, finished_records(metrics, sums, inputs, warnings));
  });
  result.warnings = std::move(warnings);
  result.stage_seconds = std::move(stage_seconds);
  return result;
}

}  // namespace cmap

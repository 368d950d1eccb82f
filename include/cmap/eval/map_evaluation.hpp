#pragma once

#include "cmap/eval/evaluation.hpp"

namespace cmap {

/// What the evaluation of one map without a reference found.
struct MapEvaluation {
  EvaluationOptions options = {};
  MetricRecords metrics = {};
  std::vector<Warning> warnings = {};
  std::vector<std::pair<std::string, double>> stage_seconds = {};
};

/// The same with what was evaluated.
struct EvaluatedMap : MapEvaluation {
  IndexedMap map;  ///< after crop and thinning
};

/// Evaluates a map by itself: crop, thinning, then every metric asked for that needs no reference, as evaluate() gives
/// it for the estimate. Throws UsageError as select_map_metrics does, otherwise as evaluate() for one of its maps. The
/// cloud is consumed. Bitwise the same for any number of threads and every instruction set.
EvaluatedMap evaluate_map(PointCloud map, const EvaluationOptions& options, const Execution& execution = {});

}  // namespace cmap

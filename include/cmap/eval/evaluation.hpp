#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cmap/align/alignment.hpp"
#include "cmap/core/progress.hpp"
#include "cmap/core/warning.hpp"
#include "cmap/eval/metric_catalog.hpp"
#include "cmap/eval/options.hpp"
#include "cmap/metrics/local_color_recall.hpp"
#include "cmap/metrics/map_pair.hpp"

namespace cmap {

/// One metric's result as the report holds it (DESIGN, "Report"): `value` (null where there is none) or
/// `per_threshold` or `per_range`, `parameters`, counts. Unit, symbol and direction are the catalog's.
struct MetricRecord {
  const MetricInfo* info;
  nlohmann::ordered_json fields;
};

/// What the evaluation of one pair found.
struct Evaluation {
  EvaluationOptions options = {};
  Eigen::Matrix4d T_ref_est = Eigen::Matrix4d::Identity();
  double overlap = 0.0;  ///< share of estimated points within the overlap distance
  double rmse_m = 0.0;
  std::vector<MetricRecord> metrics = {};         ///< in the catalog's order
  nlohmann::ordered_json aliases = {};            ///< by tool; null unless asked for
  nlohmann::ordered_json intervals = {};          ///< null unless asked for
  nlohmann::ordered_json unobserved = {};         ///< null unless asked for
  nlohmann::ordered_json sensitivity = {};        ///< of a SensitivityBand, by who made it; null unless asked for
  std::optional<Alignment> alignment = {};        ///< what gave T_ref_est, where it was not given
  std::vector<MetricRecord> metrics_before = {};  ///< of the estimate as it came, where it was aligned
  std::vector<Warning> warnings = {};
  std::vector<std::pair<std::string, double>> stage_seconds = {};
  MapPair pair;                                 ///< both maps after transform, crop and thinning, with their neighbors
  std::optional<LocalColorRecall> recall = {};  ///< where local_color_recall was computed

  const MetricRecord* find(std::string_view id) const;
};

/// Evaluates an estimated map against a reference: transform, crop, thinning, one nearest-neighbor pass each way, then
/// every metric asked for. Non-finite points must have been dropped (InputError otherwise, as for an empty cloud).
/// Throws UnsupportedError where color is required and missing, or the crop leaves nothing; UsageError for voxels too
/// small for the map. The clouds are consumed, as their memory is needed.
/// Bitwise the same for any number of threads and every instruction set.
Evaluation evaluate(PointCloud reference, PointCloud estimate, const EvaluationOptions& options,
                    const Eigen::Matrix4d& T_ref_est = Eigen::Matrix4d::Identity(), const ProgressSink& progress = {});

}  // namespace cmap

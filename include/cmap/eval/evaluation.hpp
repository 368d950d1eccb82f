#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cmap/align/alignment.hpp"
#include "cmap/core/execution.hpp"
#include "cmap/core/warning.hpp"
#include "cmap/eval/bootstrap.hpp"
#include "cmap/eval/metric_catalog.hpp"
#include "cmap/eval/observed_part.hpp"
#include "cmap/eval/options.hpp"
#include "cmap/eval/sensitivity.hpp"
#include "cmap/metrics/local_color_recall.hpp"
#include "cmap/metrics/map_pair.hpp"
#include "cmap/metrics/metric_sums.hpp"

namespace cmap {

/// The records of an evaluation, in the order of reports.
class MetricRecords {
 public:
  MetricRecords() = default;
  explicit MetricRecords(std::vector<MetricRecord> records) : records_(std::move(records)) {}

  /// Nullptr where the metric was not computed.
  const Record* find(std::string_view id) const;
  /// Throws std::out_of_range, which lists what was computed.
  const Record& at(std::string_view id) const;

  bool empty() const { return records_.empty(); }
  std::size_t size() const { return records_.size(); }
  auto begin() const { return records_.begin(); }
  auto end() const { return records_.end(); }

 private:
  std::vector<MetricRecord> records_;
};

/// What another tool would print; none where the maps do not have what it needs.
struct PeerRecord {
  std::string tool;
  std::optional<Record> record;
};

/// What the evaluation of one pair found, without the pair: small, whatever the maps' sizes.
struct Evaluation {
  EvaluationOptions options = {};
  Eigen::Matrix4d T_ref_est = Eigen::Matrix4d::Identity();
  double overlap = 0.0;  ///< share of estimated points within the overlap distance
  double rmse_m = 0.0;
  MetricRecords metrics = {};
  std::vector<PeerRecord> peers = {};           ///< of options.as
  std::optional<Intervals> intervals = {};      ///< where options.bootstrap asks for them
  std::optional<ObservedPart> unobserved = {};  ///< where options.observed asks for it
  std::optional<Sensitivity> sensitivity = {};  ///< where options.sensitivity asks for it, by who evaluated
  std::optional<Alignment> alignment = {};      ///< what gave T_ref_est, where it was not given
  MetricRecords metrics_before = {};            ///< of the estimate as it came, where it was aligned
  std::vector<Warning> warnings = {};
  std::vector<std::pair<std::string, double>> stage_seconds = {};
};

/// The same with what was evaluated, for pictures and errors a point.
struct EvaluatedPair : Evaluation {
  MapPair pair;                                 ///< both maps after transform, crop and thinning, with their neighbors
  std::optional<LocalColorRecall> recall = {};  ///< where local_color_recall was computed
};

/// Evaluates an estimated map against a reference: transform, crop, thinning, one nearest-neighbor pass each way, then
/// every metric asked for. Non-finite points must have been dropped (InputError otherwise, as for an empty cloud).
/// Throws UnsupportedError where color is required and missing, or the crop leaves nothing; UsageError for voxels too
/// small for the map, or where observed = sensor and no position of it is given (reference frame). The clouds are
/// consumed, as their memory is needed.
/// Several threads may evaluate at a time, each as its `execution` says; throws Interrupted where that stops it.
/// Bitwise the same for any number of threads and every instruction set.
EvaluatedPair evaluate(PointCloud reference, PointCloud estimate, const EvaluationOptions& options,
                       const Eigen::Matrix4d& T_ref_est = Eigen::Matrix4d::Identity(), const Execution& execution = {},
                       std::span<const Eigen::Vector3d> sensor_positions = {});

}  // namespace cmap

#include "cmap/eval/sensitivity.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "cmap/eval/evaluation.hpp"

namespace cmap {
namespace {

/// Where the estimate's centroid lies in the reference frame.
Eigen::Vector3d centroid(const PointCloud& estimate, const Eigen::Matrix4d& T_ref_est) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& p : estimate.positions) sum += p.cast<double>();
  const Eigen::Vector3d mean = estimate.origin + sum / static_cast<double>(estimate.size());
  return (T_ref_est * mean.homogeneous()).head<3>();
}

/// The twelve motions, in the reference frame.
std::vector<Eigen::Matrix4d> motions(const EvaluationOptions& options, const Eigen::Vector3d& center) {
  const double angle = options.sensitivity_rotation_deg * std::numbers::pi / 180.0;
  std::vector<Eigen::Matrix4d> all;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d direction = Eigen::Vector3d::Unit(axis);
    for (double sign : {-1.0, 1.0}) {
      Eigen::Isometry3d shift = Eigen::Isometry3d::Identity(), turn = Eigen::Isometry3d::Identity();
      shift.translation() = sign * options.sensitivity_translation_m * direction;
      turn.linear() = Eigen::AngleAxisd(sign * angle, direction).toRotationMatrix();
      turn.translation() = center - turn.linear() * center;
      all.push_back(shift.matrix());
      all.push_back(turn.matrix());
    }
  }
  return all;
}

}  // namespace

void SensitivityBand::include(const MetricRecords& metrics) {
  for (const MetricRecord& metric : metrics) {
    for (const SummedValue& value : values_of(metric.info->id, metric.record)) {
      if (!std::isfinite(value.value)) continue;
      const Range alone{value.value, value.value};
      Range& range = ranges_[value.id].try_emplace(value.threshold_m, alone).first->second;
      range = {std::min(range.lowest, value.value), std::max(range.highest, value.value)};
    }
  }
}

Sensitivity SensitivityBand::found(const EvaluationOptions& options) const {
  Sensitivity found{options.sensitivity_translation_m, options.sensitivity_rotation_deg, {}};
  for (const Metric* metric : metric_list()) {
    const auto ranges = ranges_.find(metric->info.id);
    if (ranges == ranges_.end()) continue;
    for (auto range = ranges->second.rbegin(); range != ranges->second.rend(); ++range) {
      found.ranges.push_back({metric->info.id, range->first, range->second.lowest, range->second.highest});
    }
  }
  return found;
}

SensitivityBand sensitivity_band(const PointCloud& reference, const PointCloud& estimate,
                                 const EvaluationOptions& options, const Eigen::Matrix4d& T_ref_est,
                                 const Execution& execution) {
  const ExecutionScope scope(execution);
  SensitivityBand band;
  double done = 0.0;
  const std::vector<Eigen::Matrix4d> all = motions(options, centroid(estimate, T_ref_est));
  for (const Eigen::Matrix4d& motion : all) {
    report_progress("sensitivity", done / static_cast<double>(all.size()));
    band.include(evaluate(reference, estimate, options, motion * T_ref_est).metrics);
    ++done;
  }
  return band;
}

}  // namespace cmap

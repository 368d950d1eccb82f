#include "cmap/eval/sensitivity.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "eval/json_number.hpp"
#include "eval/summed_records.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

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

void SensitivityBand::include(const Evaluation& evaluation) {
  const auto widen = [&](const MetricRecord& record, std::optional<double> threshold_m, const Json& value) {
    if (!value.is_number()) return;
    const double v = value.get<double>();
    Range& range = ranges_[std::string(record.info->id)].try_emplace(threshold_m, Range{v, v}).first->second;
    range = {std::min(range.lowest, v), std::max(range.highest, v)};
  };
  for (const MetricRecord& record : evaluation.metrics) {
    if (record.fields.contains("value")) widen(record, std::nullopt, record.fields.at("value"));
    if (!record.fields.contains("per_threshold")) continue;
    for (const Json& entry : record.fields.at("per_threshold")) {
      widen(record, entry.at("threshold_m").get<double>(), entry.at("value"));
    }
  }
}

Json SensitivityBand::json(const EvaluationOptions& options) const {
  Json metrics = Json::object();
  for (const MetricInfo& info : metric_catalog()) {
    const auto metric = ranges_.find(std::string(info.id));
    if (metric == ranges_.end()) continue;
    // The largest threshold first, as in the options' default.
    for (auto range = metric->second.rbegin(); range != metric->second.rend(); ++range) {
      add_entry(metrics, info.id, range->first,
                {{"lowest", json_number(range->second.lowest)}, {"highest", json_number(range->second.highest)}});
    }
  }
  return {{"translation_m", options.sensitivity_translation_m},
          {"rotation_deg", options.sensitivity_rotation_deg},
          {"metrics", metrics}};
}

SensitivityBand sensitivity_band(const PointCloud& reference, const PointCloud& estimate,
                                 const EvaluationOptions& options, const Eigen::Matrix4d& T_ref_est,
                                 const ProgressSink& progress) {
  EvaluationOptions plain = options;
  plain.bootstrap = 0;
  plain.observed = Observed::kNone;
  plain.as.clear();
  SensitivityBand band;
  double done = 0.0;
  const std::vector<Eigen::Matrix4d> all = motions(options, centroid(estimate, T_ref_est));
  for (const Eigen::Matrix4d& motion : all) {
    if (progress) progress("sensitivity", done / static_cast<double>(all.size()));
    band.include(evaluate(reference, estimate, plain, motion * T_ref_est));
    ++done;
  }
  return band;
}

}  // namespace cmap

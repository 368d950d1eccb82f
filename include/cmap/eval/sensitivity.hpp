#pragma once

#include <map>

#include "cmap/eval/evaluation.hpp"

namespace cmap {

/// How far every metric goes when the alignment is a little off: the report's `sensitivity`. A score that moves more
/// than two methods differ by says nothing about which one is better.
class SensitivityBand {
 public:
  /// Widens the band to the evaluation's values.
  void include(const Evaluation& evaluation);

  /// {translation_m, rotation_deg, metrics: {id: {lowest, highest} or per_threshold}}; null where nothing had a value.
  nlohmann::ordered_json json(const EvaluationOptions& options) const;

 private:
  struct Range {
    double lowest, highest;
  };
  std::map<std::string, std::map<std::optional<double>, Range>> ranges_;  ///< by metric and threshold
};

/// Evaluates the pair after each of twelve small motions of the estimate, in the reference frame: forth and back along
/// the axes by options.sensitivity_translation_m, and about them through the estimate's centroid by
/// options.sensitivity_rotation_deg. Throws as evaluate does.
SensitivityBand sensitivity_band(const PointCloud& reference, const PointCloud& estimate,
                                 const EvaluationOptions& options, const Eigen::Matrix4d& T_ref_est,
                                 const ProgressSink& progress = {});

}  // namespace cmap
